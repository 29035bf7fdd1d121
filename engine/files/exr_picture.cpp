#include "engine/files/exr_picture.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <charconv>

#include "engine/film/film.h"

namespace metamer {
namespace {

bool has_rgb(const Imf::Header& exr) {
  for (const char* name : {"R", "G", "B"})
    if (exr.channels().findChannel(name) == nullptr) return false;
  return !exr.hasType() || exr.type() == Imf::SCANLINEIMAGE || exr.type() == Imf::TILEDIMAGE;
}

std::string text(const Imf::Header& exr, const char* name) {
  const auto* attribute = exr.findTypedAttribute<Imf::StringAttribute>(name);
  return attribute == nullptr ? "" : attribute->value();
}

Imf::Slice slice(Column<float>& column, const Imath::Box2i& window, size_t width) {
  column.resize(width * (static_cast<size_t>(window.max.y - window.min.y) + 1));
  const ptrdiff_t first = ptrdiff_t{window.min.y} * static_cast<ptrdiff_t>(width) + window.min.x;
  // OpenEXR addresses pixels by their place in the plane, not in the window.
  char* origin = reinterpret_cast<char*>(column.data()) - first * static_cast<ptrdiff_t>(sizeof(float));
  return {Imf::FLOAT, origin, sizeof(float), sizeof(float) * width};
}

FileError read_part(const std::string& path, Imf::MultiPartInputFile& file, int number, ExrPicture& read) {
  const Imf::Header& exr = file.header(number);
  if (!file.partComplete(number)) return path + ": the picture is incomplete, the file was cut short";
  const Imath::Box2i window = exr.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  if (const auto mistake = check_frame_size(static_cast<uint64_t>(width), static_cast<uint64_t>(height)))
    return path + ": " + *mistake;
  ExrPicture found;
  Picture& picture = found.picture;
  picture.width = static_cast<uint32_t>(width);
  picture.height = static_cast<uint32_t>(height);
  Imf::FrameBuffer buffer;
  buffer.insert("R", slice(picture.r, window, picture.width));
  buffer.insert("G", slice(picture.g, window, picture.width));
  buffer.insert("B", slice(picture.b, window, picture.width));
  Imf::InputPart part(file, number);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  if (Imf::hasChromaticities(exr)) {
    const Imf::Chromaticities& c = Imf::chromaticities(exr);
    found.chromaticities = {{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}};
  }
  found.color = text(exr, "metamer:color");
  const std::string stops = text(exr, "metamer:exposure_stops");
  float value = 0;
  if (std::from_chars(stops.data(), stops.data() + stops.size(), value).ec == std::errc()) found.exposure_stops = value;
  read = std::move(found);
  return std::nullopt;
}

}  // namespace

FileError read_exr_picture(const std::string& path, ExrPicture& read) {
  try {
    Imf::MultiPartInputFile file(path.c_str());
    for (int number = 0; number < file.parts(); ++number)
      if (has_rgb(file.header(number))) return read_part(path, file, number, read);
    return path + ": holds no picture with channels R, G and B";
  } catch (const std::exception& error) {
    return fmt::format("{}: cannot be read: {}", path, error.what());
  }
}

}  // namespace metamer
