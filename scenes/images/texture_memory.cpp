#include "scenes/images/texture_memory.h"

#include "engine/schedule/workers.h"
#include "systems/texture_memory.h"

namespace metamer {
namespace {

struct Job {
  Image& image;
  Diagnostics diagnostics;  // what there was to say has been said, but the file may have gone
};

void read_again(void* context, uint32_t, size_t nth) {
  Job& job = (*static_cast<std::vector<Job>*>(context))[nth];
  const std::string path = job.image.name;
  const ColorSpace space = job.image.color_space;
  read_image(path, {path, 0}, job.image, job.diagnostics, job.image.encoding);
  job.image.color_space = space;  // the scene may have named another than the file
}

}  // namespace

void read_images_that_fit(Scene& scene, Diagnostics& diagnostics) {
  const std::vector<bool> fits = images_that_fit(scene);
  std::vector<Job> jobs;
  for (size_t id = 0; id < fits.size(); ++id)
    if (fits[id] && scene.images[id].is_in_file) jobs.push_back({scene.images[id], {}});
  run_units(available_threads(), jobs.size(), Cancellation(), read_again, &jobs);
  for (const Job& job : jobs)
    for (const Diagnostic& d : job.diagnostics.all())
      if (d.severity == Severity::error) diagnostics.error({d.file, d.line}, d.message);
}

}  // namespace metamer
