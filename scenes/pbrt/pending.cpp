// Files that statements only name are read together: on all threads, while the outcome stays that of one.
#include <vector>

#include "engine/schedule/workers.h"
#include "scenes/append_diagnostics.h"
#include "scenes/images/texture_memory.h"
#include "scenes/meshes/read_mesh.h"
#include "scenes/pbrt/reader.h"
#include "scenes/volumes/medium_box.h"

namespace metamer::pbrt {
namespace {

struct Job {
  const PendingFile& file;
  Scene& scene;
  Diagnostics diagnostics;
};

void read_file_of(Job& job) {
  const PendingFile& file = job.file;
  if (file.mesh != no_index) {
    Mesh& mesh = job.scene.meshes[file.mesh];
    if (read_ply(file.path, file.named_at, mesh, job.diagnostics)) validate_mesh(mesh, file.named_at, job.diagnostics);
  } else {
    read_image(file.path, file.named_at, job.scene.images[file.image], job.diagnostics, file.encoding,
               pixels_of_textures(job.scene));
  }
}

// pbrt clips media of files to the box of their active voxels.
void read_pending_grids(Reader& reader) {
  std::vector<GridRequest> requests;
  for (const PendingGrid& pending : reader.pending_grids) requests.push_back(pending.request);
  read_grids(requests, reader.messages.diagnostics);
  std::map<uint32_t, std::vector<GridId>> grids_of;  // by entity
  Registry& registry = reader.scene.registry;
  for (size_t i = 0; i < requests.size(); ++i) {
    if (!requests[i].found) continue;
    requests[i].grid.name = requests[i].path + ":" + requests[i].grid_name;
    reader.scene.grids.push_back(std::move(requests[i].grid));
    const auto id = static_cast<GridId>(reader.scene.grids.size() - 1);
    for (const PendingGrid::Use& use : reader.pending_grids[i].uses) {
      MediumGrid medium = registry.get<MediumGrid>(use.medium);
      medium.*use.handle = id;
      std::vector<const Grid*> grids;
      grids_of[use.medium.index].push_back(id);
      for (const GridId known : grids_of[use.medium.index]) grids.push_back(&reader.scene.grids[known]);
      set_medium_box(medium, grids, 0);
      registry.set(use.medium, medium);
    }
  }
  reader.pending_grids.clear();
}

}  // namespace

void read_pending(Reader& reader) {
  read_pending_grids(reader);
  std::vector<Job> jobs;
  for (const PendingFile& file : reader.pending_files) jobs.push_back({file, reader.scene, {}});
  const auto read = [](void* context, uint32_t, size_t unit) {
    read_file_of((*static_cast<std::vector<Job>*>(context))[unit]);
  };
  run_units(available_threads(), jobs.size(), Cancellation(), read, &jobs);
  for (const Job& job : jobs) append_diagnostics(reader.messages.diagnostics, job.diagnostics);
  reader.pending_files.clear();
  for (const TextureId id : reader.may_take_alpha) {
    Texture& texture = reader.scene.textures[id];
    if (reader.scene.images[texture.image].file_has_alpha) texture.channel = TextureChannel::alpha;
  }
  reader.may_take_alpha.clear();
  if (!reader.messages.diagnostics.has_errors()) read_images_that_fit(reader.scene, reader.messages.diagnostics);
}

}  // namespace metamer::pbrt
