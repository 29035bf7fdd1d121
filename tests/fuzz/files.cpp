// Readers of a single file.
#include <cmath>

#include "scenes/gzip.h"
#include "scenes/meshes/read_mesh.h"
#include "scenes/native/read_native.h"
#include "scenes/pbrt/read_pbrt.h"
#include "scenes/program/spectrum_file.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"

namespace metamer::fuzz {
namespace {

void read_scene_with_spectra(const std::string& value) {
  std::string text = "Camera \"perspective\" WorldBegin\n";
  text += "Material \"diffuse\" \"spectrum reflectance\" " + value + "\n";
  text += "Material \"conductor\" \"spectrum eta\" " + value + "\n";
  text += "LightSource \"point\" \"spectrum I\" " + value + "\n";
  Scene scene;
  Diagnostics diagnostics;
  const bool ok = read_pbrt(scratch().write("scene.pbrt", text), scene, diagnostics);
  require_consistent(ok, diagnostics);
  if (!ok) return;
  require_valid(scene);
  for (SpectrumId id = 0; id < scene.spectra.size(); ++id) {
    require(std::isfinite(scene.spectra.max_value(id)), "spectra are finite");
    require(scene.spectra.min_value(id) >= 0, "spectra are not negative");
  }
}

}  // namespace

void ply(std::string_view input) {
  Mesh mesh;
  Diagnostics diagnostics;
  const bool ok = read_ply_text(input, "mesh.ply", mesh, diagnostics);
  require_consistent(ok, diagnostics);
  Diagnostics mistakes;
  if (ok) require(validate_mesh(mesh, {}, mistakes), "what a PLY file holds is a valid mesh");
}

void gzip(std::string_view input) {
  FileBytes bytes;
  Diagnostics diagnostics;
  const bool ok = read_packed_file(scratch().write("packed.gz", input), {"scene", 1}, bytes, diagnostics);
  require_consistent(ok, diagnostics);
  if (ok) require(bytes.size <= most_unpacked_bytes(input.size()), "what is unpacked is bounded");
  scratch().clear();
}

void spectra(std::string_view input) {
  const std::string file = scratch().write("table.spd", input);
  read_scene_with_spectra("\"table.spd\"");
  // Between brackets it is anything but a name of a file.
  if (input.find('"') == std::string_view::npos) read_scene_with_spectra("[" + std::string(input) + "]");
  Diagnostics diagnostics;
  const Samples samples = read_spectrum_file(file, diagnostics);
  for (const double sample : samples) require(std::isfinite(sample) && sample >= 0, "samples are amounts of light");
  scratch().clear();
}

void native(std::string_view input) {
  if (names_outside(input)) return;
  Scene scene;
  Diagnostics diagnostics;
  const bool ok = read_native(scratch().path("scene.json"), copy_bytes(input), scene, diagnostics);
  require_consistent(ok, diagnostics);
  if (ok) require_valid(scene);
}

}  // namespace metamer::fuzz
