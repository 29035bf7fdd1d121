#include "engine/files/spectral_exr.h"

#include <ImfChannelList.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>

#include "engine/files/exr_bands.h"
#include "engine/files/exr_header.h"
#include "engine/schedule/workers.h"

namespace metamer {
namespace {

struct BandChannel {
  double wavelength_nm;
  std::string name;
};

// Ascending in wavelength.
std::vector<BandChannel> band_channels(const Imf::Header& exr) {
  std::vector<BandChannel> channels;
  for (auto it = exr.channels().begin(); it != exr.channels().end(); ++it)
    if (const std::optional<double> wavelength_nm = channel_wavelength_nm(it.name()))
      channels.push_back({*wavelength_nm, it.name()});
  std::sort(channels.begin(), channels.end(),
            [](const BandChannel& a, const BandChannel& b) { return a.wavelength_nm < b.wavelength_nm; });
  return channels;
}

// The edges that our own files state, else half-way between the wavelengths and as far beyond the first and the last; a
// single band's edges do not matter, since its curve is constant.
std::vector<double> band_edges(const Imf::Header& exr, const std::vector<BandChannel>& channels) {
  const size_t count = channels.size();
  if (const auto* stated = exr.findTypedAttribute<Imf::FloatVectorAttribute>(band_edges_attribute)) {
    const std::vector<float>& e = stated->value();
    bool fits = e.size() == count + 1;
    for (size_t b = 0; fits && b < count; ++b)
      fits = e[b] < channels[b].wavelength_nm && channels[b].wavelength_nm < e[b + 1];
    if (fits) return {e.begin(), e.end()};
  }
  const auto at = [&](size_t b) { return channels[b].wavelength_nm; };
  const double first = count > 1 ? at(1) - at(0) : 1, last = count > 1 ? at(count - 1) - at(count - 2) : 1;
  std::vector<double> edges_nm = {at(0) - first / 2};
  for (size_t b = 1; b < count; ++b) edges_nm.push_back((at(b - 1) + at(b)) / 2);
  edges_nm.push_back(at(count - 1) + last / 2);
  return edges_nm;
}

// What is wrong with a part's channels of radiance, if anything.
std::optional<std::string> check_channels(const Imf::Header& exr, const std::vector<BandChannel>& channels) {
  for (size_t b = 0; b < channels.size(); ++b) {
    const Imf::Channel& channel = exr.channels()[channels[b].name];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      return fmt::format("its channel '{}' does not have every pixel", channels[b].name);
    if (b > 0 && channels[b].wavelength_nm - channels[b - 1].wavelength_nm < 1e-6)
      return fmt::format("its channels '{}' and '{}' are of one wavelength", channels[b - 1].name, channels[b].name);
  }
  std::string units = exr_text(exr, "emissiveUnits");
  std::erase(units, ' ');
  if (!units.empty() && units != spectral_units && units != "W.m^-2.sr^-1")
    return fmt::format("its emissiveUnits are '{}', {} or W.m^-2.sr^-1 were expected", units, spectral_units);
  return std::nullopt;
}

FileError read_part(const std::string& path, const Imf::MultiPartInputFile& file, int number, SpectralPicture& picture,
                    FrameHeader& header) {
  const Imf::Header& exr = file.header(number);
  const std::vector<BandChannel> channels = band_channels(exr);
  if (const auto mistake = check_channels(exr, channels)) return fmt::format("{}: {}", path, *mistake);
  if (!file.partComplete(number)) return fmt::format("{}: the picture is incomplete, the file was cut short", path);
  const Imath::Box2i window = exr.dataWindow();
  const int64_t columns = int64_t{window.max.x} - window.min.x + 1, rows = int64_t{window.max.y} - window.min.y + 1;
  if (const auto mistake =
          check_spectral_picture_size(static_cast<uint64_t>(columns), static_cast<uint64_t>(rows), channels.size()))
    return fmt::format("{}: {}", path, *mistake);
  SpectralPicture read{static_cast<uint32_t>(columns), static_cast<uint32_t>(rows), band_edges(exr, channels), {}};
  read.bands.resize(channels.size());
  Imf::FrameBuffer buffer;
  for (size_t b = 0; b < channels.size(); ++b) {
    read.bands[b].resize(static_cast<size_t>(columns) * static_cast<size_t>(rows));
    buffer.insert(channels[b].name, Imf::Slice::Make(Imf::FLOAT, read.bands[b].data(), window, sizeof(float),
                                                     sizeof(float) * read.width));
  }
  Imf::InputPart part(const_cast<Imf::MultiPartInputFile&>(file), number);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  picture = std::move(read);
  header = read_exr_header(exr);
  return std::nullopt;
}

FileError read_any_part(const std::string& path, SpectralPicture& picture, FrameHeader& header) {
  const int threads = static_cast<int>(available_threads());
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  const Imf::MultiPartInputFile file(path.c_str(), threads);
  bool has_reflectances = false;
  for (int number = 0; number < file.parts(); ++number) {
    if (!band_channels(file.header(number)).empty()) return read_part(path, file, number, picture, header);
    for (auto it = file.header(number).channels().begin(); it != file.header(number).channels().end(); ++it)
      has_reflectances = has_reflectances || std::string_view(it.name()).starts_with("T.");
  }
  return fmt::format("{}: holds no bands of light (channels such as S0.550,000nm){}", path,
                     has_reflectances ? ", only reflectances (channels T)" : "");
}

}  // namespace

FileError look_into_exr(const std::string& path, ExrContents& contents) {
  try {
    const Imf::MultiPartInputFile file(path.c_str());
    contents = {};
    for (int part = 0; part < file.parts(); ++part) {
      const Imf::Header& exr = file.header(part);
      contents.has_film = contents.has_film || (exr.hasName() && exr.name() == film_part);
      contents.has_bands = contents.has_bands || !band_channels(exr).empty();
    }
    return std::nullopt;
  } catch (const std::exception& error) {
    return fmt::format("{}: cannot be read: {}", path, error.what());
  }
}

FileError read_spectral_picture(const std::string& path, SpectralPicture& picture, FrameHeader& header) {
  try {
    return read_any_part(path, picture, header);
  } catch (const std::exception& error) {
    return fmt::format("{}: cannot be read: {}", path, error.what());
  }
}

}  // namespace metamer
