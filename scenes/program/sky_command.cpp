#include <fmt/format.h>
#include <json/writer.h>

#include <filesystem>
#include <numbers>

#include "engine/files/output_kind.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "systems/display_colour.h"

namespace metamer {
namespace {

void check(const FileError& error) {
  if (error) throw Failure(exit_failed, *error);
}

void print_day(const SkySettings& settings, const SkyImage& sky) {
  const Color3 zenith = SkyModel(settings.turbidity, settings.sun_elevation_deg).zenith();
  const auto on_ground = [](const char* name, const Color3& xyz) {
    const auto [x, y] = chromaticity(xyz);
    fmt::print("{:<8}{:.0f} lx on the ground, x {:.4f} y {:.4f}\n", name, xyz[1], x, y);
  };
  fmt::print("{:<8}{:.0f} cd/m^2, x {:.4f} y {:.4f}\n", "zenith", zenith[0], zenith[1], zenith[2]);
  on_ground("sky", sky.sky_illuminance);
  if (!settings.has_sun) return;
  on_ground("sun", sky.sun_illuminance);
  const double facing = sky.sun_illuminance[1] / sun_direction(settings).z;
  fmt::print("{:<8}{:.0f} lx facing it, {:.3g} cd/m^2\n", "", facing, facing / sun_projected_solid_angle());
  fmt::print("{:<8}{:.0f} lx on the ground\n", "both", sky.sky_illuminance[1] + sky.sun_illuminance[1]);
}

void write_image(const std::string& path, const Image& image) {
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  for (Column<float>* channel : {&picture.r, &picture.g, &picture.b}) channel->resize(picture.pixel_count());
  for (size_t pixel = 0; pixel < picture.pixel_count(); ++pixel) {
    picture.r[pixel] = image.rgb[3 * pixel];
    picture.g[pixel] = image.rgb[3 * pixel + 1];
    picture.b[pixel] = image.rgb[3 * pixel + 2];
  }
  FrameHeader header;
  header.chromaticities = display_chromaticities(image.color_space);
  header.software = "metamer " METAMER_VERSION;
  header.scene = "sky";
  check(write_exr(path, picture, header, SampleTotals{}, nullptr));
}

// What `metamer` would make of the light "sky", with y up: north is -z.
std::string scene_text(const SkySettings& settings, const std::string& image_name) {
  std::string text = fmt::format(
      "{{\n  \"metamer\": 1,\n  \"entities\": [\n    {{\n      \"name\": \"sky\",\n"
      "      \"transform\": {{ \"rotate\": {{ \"axis\": [1, 0, 0], \"degrees\": -90 }} }},\n"
      "      \"light\": {{ \"type\": \"environment\", \"image\": {}, \"space\": \"rec2020\" }}\n    }}",
      Json::valueToQuotedString(image_name.c_str()));
  if (settings.has_sun) {
    const glm::dvec3 d = sun_direction(settings);
    text += fmt::format(
        ",\n    {{\n      \"name\": \"sun\",\n      \"transform\": {{ \"look_at\": {{ \"from\": [{}, {}, {}], "
        "\"to\": [0, 0, 0], \"up\": [{}] }} }},\n"
        "      \"light\": {{\n        \"type\": \"directional\",\n        \"angular_diameter\": {},\n"
        "        \"irradiance\": {{\n          \"table\": [",
        d.x, d.z, -d.y, d.z > 0.9 ? "0, 0, -1" : "0, 1, 0", sun_diameter_deg);
    const Samples radiance = sun_radiance(settings.turbidity, settings.sun_elevation_deg);
    for (size_t i = 0; i < lambda_count; ++i)
      text += fmt::format("{}[{}, {:.6g}]",
                          i == 0       ? ""
                          : i % 8 == 0 ? ",\n            "
                                       : ", ",
                          lambda_min_nm + static_cast<int>(i), radiance[i] * sun_projected_solid_angle());
    text += "]\n        }\n      }\n    }";
  }
  return text + "\n  ]\n}\n";
}

void write_scene(const std::string& path, const SkySettings& settings, const SkyImage& sky) {
  std::filesystem::path image = path;
  image.replace_extension(".exr");
  check(check_target(image.string()));
  const std::string text = scene_text(settings, image.filename().string());
  write_image(image.string(), sky.image);
  AtomicFile file;
  check(file.open(path));
  check(file.write(text.data(), text.size()));
  check(file.commit());
  fmt::print("EXR   {}\nJSON  {}\n", image.string(), path);
}

}  // namespace

int run_sky(const SkyArguments& arguments) {
  const std::string ending = in_lower_case(std::filesystem::path(arguments.output).extension().string());
  const bool is_scene = ending == ".json";
  if (!arguments.output.empty()) {
    if (!is_scene && ending != ".exr")
      throw Failure(exit_wrong_input,
                    fmt::format("--output: {}: expected a name ending in .json or .exr", arguments.output));
    check(check_target(arguments.output));
  }
  const SkyImage sky = make_sky(arguments.settings);
  print_day(arguments.settings, sky);
  if (is_scene) {
    write_scene(arguments.output, arguments.settings, sky);
  } else if (!arguments.output.empty()) {
    write_image(arguments.output, sky.image);
    fmt::print("EXR   {}\n", arguments.output);
  }
  return exit_done;
}

}  // namespace metamer
