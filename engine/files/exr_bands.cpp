#include "engine/files/exr_bands.h"

#include <ImfChannelList.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace metamer {
namespace {

constexpr uint32_t words_per_band = sizeof(BandSum) / sizeof(uint32_t);
constexpr double speed_of_light = 299792458;  // m/s

// Rows that are held packed at one time: blocks of 16 rows are what the format compresses, several at once where
// OpenEXR has threads.
uint32_t rows_at_once(uint32_t height) { return std::min<uint32_t>(height, 64); }

double power_of_ten(std::string_view prefix) {
  constexpr std::pair<std::string_view, double> prefixes[] = {
      {"", 1},    {"Y", 1e24}, {"Z", 1e21}, {"E", 1e18}, {"P", 1e15}, {"T", 1e12}, {"G", 1e9},  {"M", 1e6},  {"k", 1e3},
      {"h", 1e2}, {"da", 1e1}, {"d", 1e-1}, {"c", 1e-2}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}, {"p", 1e-12}};
  for (const auto& [name, factor] : prefixes)
    if (name == prefix) return factor;
  return 0;
}

std::string band_sum_channel(uint32_t band, uint32_t word) {
  return word < 3 ? fmt::format("band{}.radiance.limb{}", band, word)
                  : fmt::format("band{}.weight.limb{}", band, word - 3);
}

// A frame buffer over rows of band sums, of which `first_row` is the first.
Imf::FrameBuffer sums_buffer(std::span<BandSum> sums, uint32_t width, uint32_t band_count, uint32_t first_row) {
  const size_t x_stride = band_count * sizeof(BandSum), y_stride = x_stride * width;
  char* origin = reinterpret_cast<char*>(sums.data()) - static_cast<ptrdiff_t>(y_stride) * first_row;
  Imf::FrameBuffer buffer;
  for (uint32_t b = 0; b < band_count; ++b)
    for (uint32_t word = 0; word < words_per_band; ++word)
      buffer.insert(
          band_sum_channel(b, word),
          Imf::Slice(Imf::UINT, origin + (size_t{b} * words_per_band + word) * sizeof(uint32_t), x_stride, y_stride));
  return buffer;
}

// Whether a pixel's band can have come from that many samples.
bool is_sound(const BandSum& sum, uint64_t samples) {
  constexpr uint64_t wavelengths = 4, largest_weight = uint64_t{1} << (14 + 20);
  const FixedSum largest = to_units<band_unit_log2>(band_sample_limit) * static_cast<FixedSum>(samples * wavelengths);
  const FixedSum radiance = sum.radiance_units();
  return radiance <= largest && radiance >= -largest && sum.weight_units() <= samples * wavelengths * largest_weight;
}

}  // namespace

std::string band_channel(double center_nm) {
  std::string number = fmt::format("{:.3f}", center_nm);
  std::replace(number.begin(), number.end(), '.', ',');
  return fmt::format("S0.{}nm", number);
}

std::optional<double> channel_wavelength_nm(std::string_view name) {
  if (!name.starts_with("S0.")) return std::nullopt;
  std::string text(name.substr(3));
  std::replace(text.begin(), text.end(), ',', '.');
  double number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view unit(end, static_cast<size_t>(text.data() + text.size() - end));
  if (failed != std::errc() || !(number > 0)) return std::nullopt;
  const bool is_frequency = unit.ends_with("Hz");
  if (!is_frequency && !unit.ends_with("m")) return std::nullopt;
  unit.remove_suffix(is_frequency ? 2 : 1);
  const double value = number * power_of_ten(unit);
  const double wavelength_nm = is_frequency ? speed_of_light / value * 1e9 : value * 1e9;
  return value > 0 && std::isfinite(wavelength_nm) ? std::optional(wavelength_nm) : std::nullopt;
}

void describe_bands(Imf::Header& picture, uint32_t band_count) {
  const std::vector<double> edges_nm = band_edges_nm(band_count);
  for (uint32_t b = 0; b < band_count; ++b)
    picture.channels().insert(band_channel((edges_nm[b] + edges_nm[b + 1]) / 2), Imf::Channel(Imf::FLOAT));
  picture.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
  picture.insert("emissiveUnits", Imf::StringAttribute(spectral_units));
  picture.insert(band_edges_attribute, Imf::FloatVectorAttribute({edges_nm.begin(), edges_nm.end()}));
}

void write_picture(Imf::OutputPart part, const Picture& picture, const Film* spectral) {
  const uint32_t band_count = spectral == nullptr ? 0 : spectral->band_count();
  const std::vector<double> edges_nm = band_edges_nm(band_count);
  const uint32_t rows_per_block = band_count == 0 ? picture.height : rows_at_once(picture.height);
  std::vector<std::vector<float>> means(band_count);
  std::vector<float*> columns;
  for (std::vector<float>& column : means) {
    column.resize(size_t{picture.width} * rows_per_block);
    columns.push_back(column.data());
  }
  const size_t y_stride = sizeof(float) * picture.width;
  const Imath::Box2i window = part.header().dataWindow();
  const auto slice = [&](const float* values, size_t first_row) {
    char* origin = reinterpret_cast<char*>(const_cast<float*>(values));  // only read when writing a file
    const ptrdiff_t before = static_cast<ptrdiff_t>(y_stride) * (window.min.y + static_cast<ptrdiff_t>(first_row)) +
                             static_cast<ptrdiff_t>(sizeof(float)) * window.min.x;
    return Imf::Slice(Imf::FLOAT, origin - before, sizeof(float), y_stride);
  };
  for (uint32_t row = 0; row < picture.height; row += rows_per_block) {
    const uint32_t rows = std::min(rows_per_block, picture.height - row);
    if (band_count > 0) band_means(*spectral, size_t{row} * picture.width, size_t{rows} * picture.width, columns);
    Imf::FrameBuffer buffer;
    buffer.insert("R", slice(picture.r.data(), 0));
    buffer.insert("G", slice(picture.g.data(), 0));
    buffer.insert("B", slice(picture.b.data(), 0));
    for (uint32_t b = 0; b < band_count; ++b)
      buffer.insert(band_channel((edges_nm[b] + edges_nm[b + 1]) / 2), slice(columns[b], row));
    part.setFrameBuffer(buffer);
    part.writePixels(static_cast<int>(rows));
  }
}

void add_band_sum_channels(Imf::Header& bands, uint32_t band_count) {
  for (uint32_t b = 0; b < band_count; ++b)
    for (uint32_t word = 0; word < words_per_band; ++word)
      bands.channels().insert(band_sum_channel(b, word), Imf::Channel(Imf::UINT));
}

void write_band_sums(Imf::OutputPart part, const Film& film) {
  // Only read when writing a file.
  const std::span<BandSum> sums(const_cast<BandSum*>(film.bands().data()), film.bands().size());
  part.setFrameBuffer(sums_buffer(sums, film.width(), film.band_count(), 0));
  part.writePixels(static_cast<int>(film.height()));
}

std::optional<std::string> read_band_sums(Imf::InputPart part, Film& film) {
  const uint32_t band_count = film.band_count();
  for (uint32_t b = 0; b < band_count; ++b)
    for (uint32_t word = 0; word < words_per_band; ++word)
      if (const Imf::Channel* channel = part.header().channels().findChannel(band_sum_channel(b, word));
          channel == nullptr || channel->type != Imf::UINT)
        return fmt::format("its bands have no UINT channel '{}'", band_sum_channel(b, word));
  part.setFrameBuffer(sums_buffer(film.bands(), film.width(), band_count, 0));
  part.readPixels(0, static_cast<int>(film.height()) - 1);
  for (size_t i = 0; i < film.bands().size(); ++i) {
    const size_t pixel = i / band_count;
    if (!is_sound(film.bands()[i], film.counts()[pixel].total()))
      return fmt::format("band {} is damaged at pixel {},{}: its sums and the sample counts do not agree",
                         i % band_count, pixel % film.width(), pixel / film.width());
  }
  return std::nullopt;
}

}  // namespace metamer
