#include "engine/files/png_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <vector>

namespace metamer {
namespace {

std::vector<uint8_t> interleaved(const CodedPicture& picture) {
  std::vector<uint8_t> bytes;
  bytes.reserve(picture.codes.size() * 3);
  for (const uint32_t code : picture.codes)
    for (int shift = 0; shift < 24; shift += 8) bytes.push_back(static_cast<uint8_t>(code >> shift));
  return bytes;
}

// OpenImageIO compresses into memory, so that only the atomic file touches the disk.
FileError encode(const std::string& path, const CodedPicture& picture, const std::string& software, PngColours colours,
                 const std::vector<uint8_t>& icc, std::vector<unsigned char>& file) {
  OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height), 3, OIIO::TypeUInt8);
  if (colours == PngColours::srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (!icc.empty())
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(icc.size())), icc.data());
  spec.attribute("Software", software);
  OIIO::Filesystem::IOVecOutput memory(file);
  const std::unique_ptr<OIIO::ImageOutput> png = OIIO::ImageOutput::create("png");
  if (!png) return fmt::format("{}: OpenImageIO here writes no PNG: {}", path, OIIO::geterror());
  if (!png->set_ioproxy(&memory) || !png->open("frame.png", spec) ||
      !png->write_image(OIIO::TypeUInt8, interleaved(picture).data()) || !png->close())
    return fmt::format("{}: writing failed: {}", path, png->geterror());
  return std::nullopt;
}

FileError write(const std::string& path, const CodedPicture& picture, const std::string& software, PngColours colours,
                const std::vector<uint8_t>& icc) {
  AtomicFile file;
  if (const FileError error = file.open(path)) return error;
  std::vector<unsigned char> bytes;
  if (const FileError error = encode(path, picture, software, colours, icc, bytes)) return error;
  if (const FileError error = file.write(bytes.data(), bytes.size())) return error;
  return file.commit();
}

}  // namespace

FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software,
                    PngColours colours) {
  return write(path, picture, software, colours, {});
}

FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software,
                    const std::vector<uint8_t>& icc) {
  return write(path, picture, software, PngColours::unknown, icc);
}

}  // namespace metamer
