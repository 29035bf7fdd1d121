// The only file that knows OpenColorIO.
#include "systems/ocio_view.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/schedule/workers.h"
#include "systems/colour_match.h"
#include "systems/display_colour.h"

namespace ocio = OCIO_NAMESPACE;

namespace metamer {
namespace {

// The D65 of OpenColorIO's X Y Z: x, y as ITU-R BT.709 rounds them.
Color3 ocio_d65() { return xyz_of_chromaticity(0.3127, 0.3290); }

// White becomes white, by Bradford.
Matrix3 between(ColorSpace from, ColorSpace to) {
  const Matrix3 adapted =
      multiply(adaptation_matrix(Adaptation::bradford, white_xyz(from), white_xyz(to)), display_to_xyz(from));
  return multiply(xyz_to_rgb(to), adapted);
}

void apply_matrix(const Matrix3& matrix, Picture& picture) {
  Picture result{picture.width, picture.height, {}, {}, {}};
  colour_match(rounded(matrix), picture.r, picture.g, picture.b, result.r, result.g, result.b);
  picture = std::move(result);
}

// OpenColorIO's tables are indexed by half floats: not-a-number and what lies beyond them would be lost.
void limit(Picture& picture) {
  constexpr float largest_half = 65504.0f;
  for (Column<float>* column : {&picture.r, &picture.g, &picture.b})
    for (float& v : *column) v = std::isnan(v) ? 0.0f : std::clamp(v, -largest_half, largest_half);
}

void apply_processor(const ocio::ConstCPUProcessorRcPtr& processor, Picture& picture, uint32_t threads) {
  static constexpr size_t block = size_t{1} << 14;
  struct Context {
    const ocio::CPUProcessor& processor;
    Picture& picture;
  } context{*processor, picture};
  const size_t blocks = (picture.pixel_count() + block - 1) / block;
  const size_t workers = std::min<size_t>(threads == 0 ? available_threads() : threads, blocks);
  run_units(
      static_cast<uint32_t>(workers), blocks, Cancellation(),
      [](void* shared, uint32_t, size_t unit) {
        const Context& c = *static_cast<Context*>(shared);
        const size_t begin = unit * block, count = std::min(block, c.picture.pixel_count() - begin);
        ocio::PlanarImageDesc pixels(c.picture.r.data() + begin, c.picture.g.data() + begin, c.picture.b.data() + begin,
                                     nullptr, static_cast<long>(count), 1);
        c.processor.apply(pixels);
      },
      &context);
}

ocio::BuiltinTransformRcPtr builtin(const char* style, ocio::TransformDirection direction) {
  ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  transform->setDirection(direction);
  return transform;
}

ocio::ConstConfigRcPtr read_config(const std::string& path) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);  // what is wrong is said by us
  return ocio::Config::CreateFromFile(path.c_str());
}

struct Entrance {
  std::string space;
  ColorSpace holds;
};
Entrance entrance_of(const ocio::Config& config) {
  for (const char* name : {ocio::ROLE_INTERCHANGE_SCENE, "ACES2065-1", "ACES - ACES2065-1"})
    if (config.getColorSpace(name)) return {name, ColorSpace::aces2065_1};
  return {ocio::ROLE_SCENE_LINEAR, ColorSpace::srgb};
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// The name among those there are, or what to say instead.
OcioError find_name(const char* flag, const std::string& config, std::string_view name,
                    const std::vector<std::string_view>& names, const std::string& of) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return std::nullopt;
  return fmt::format("{}: {} has no '{}'{}{}; there are {}", flag, config, name, of, did_you_mean(name, names),
                     fmt::join(names, ", "));
}

OcioError resolve_names(const ocio::Config& config, OcioView& view) {
  if (view.display.empty()) view.display = config.getDefaultDisplay();
  std::vector<std::string_view> displays, views;
  for (int i = 0; i < config.getNumDisplays(); ++i) displays.emplace_back(config.getDisplay(i));
  if (OcioError error = find_name("--ocio-display", view.config, view.display, displays, "")) return error;
  if (view.view.empty()) view.view = config.getDefaultView(view.display.c_str());
  for (int i = 0; i < config.getNumViews(view.display.c_str()); ++i)
    views.emplace_back(config.getView(view.display.c_str(), i));
  return find_name("--ocio-view", view.config, view.view, views, fmt::format(" for the display '{}'", view.display));
}

template <class Function>
OcioError reporting(const std::string& whose, Function&& function) {
  try {
    return function();
  } catch (const std::exception& error) {
    return fmt::format("{}: {}", whose, one_line(error.what()));
  }
}

}  // namespace

OcioError resolve(OcioView& view) {
  return reporting(view.config, [&] { return resolve_names(*read_config(view.config), view); });
}

OcioError apply_aces(Picture& picture, ColorSpace display, uint32_t threads) {
  return reporting("OpenColorIO", [&]() -> OcioError {
    constexpr const char* style = "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0";
    const auto processor = ocio::Config::CreateRaw()->getProcessor(builtin(style, ocio::TRANSFORM_DIR_FORWARD));
    apply_matrix(between(display, ColorSpace::aces2065_1), picture);
    limit(picture);
    apply_processor(processor->getDefaultCPUProcessor(), picture, threads);
    const Matrix3 from_d65 = adaptation_matrix(Adaptation::bradford, ocio_d65(), white_xyz(display));
    apply_matrix(multiply(inverse(display_to_xyz(display)), from_d65), picture);
    return std::nullopt;
  });
}

OcioError apply_view(Picture& picture, ColorSpace display, const OcioView& view, uint32_t threads) {
  return reporting(view.config, [&]() -> OcioError {
    const ocio::ConstConfigRcPtr config = read_config(view.config);
    const Entrance entrance = entrance_of(*config);
    ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
    transform->setSrc(entrance.space.c_str());
    transform->setDisplay(view.display.c_str());
    transform->setView(view.view.c_str());
    const auto processor = config->getProcessor(transform);
    apply_matrix(between(display, entrance.holds), picture);
    limit(picture);
    apply_processor(processor->getDefaultCPUProcessor(), picture, threads);
    return std::nullopt;
  });
}

}  // namespace metamer
