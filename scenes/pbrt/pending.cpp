// Files that statements only name are read together: on all threads, while the outcome stays that of one.
#include <vector>

#include "engine/schedule/workers.h"
#include "scenes/images/texture_memory.h"
#include "scenes/meshes/read_mesh.h"
#include "scenes/pbrt/reader.h"

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

void append(Diagnostics& all, const Diagnostics& some) {
  for (const Diagnostic& d : some.all()) {
    const SourceLocation at{d.file, d.line};
    switch (d.severity) {
      case Severity::note: all.note(at, d.message, d.strict); break;
      case Severity::warning: all.warning(at, d.message, d.strict); break;
      case Severity::error: all.error(at, d.message); break;
    }
  }
}

}  // namespace

void read_pending(Reader& reader) {
  std::vector<Job> jobs;
  for (const PendingFile& file : reader.pending_files) jobs.push_back({file, reader.scene, {}});
  const auto read = [](void* context, uint32_t, size_t unit) {
    read_file_of((*static_cast<std::vector<Job>*>(context))[unit]);
  };
  run_units(available_threads(), jobs.size(), Cancellation(), read, &jobs);
  for (const Job& job : jobs) append(reader.messages.diagnostics, job.diagnostics);
  reader.pending_files.clear();
  for (const TextureId id : reader.may_take_alpha) {
    Texture& texture = reader.scene.textures[id];
    if (reader.scene.images[texture.image].file_has_alpha) texture.channel = TextureChannel::alpha;
  }
  reader.may_take_alpha.clear();
  if (!reader.messages.diagnostics.has_errors()) read_images_that_fit(reader.scene, reader.messages.diagnostics);
}

}  // namespace metamer::pbrt
