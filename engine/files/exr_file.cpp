// The only file that knows OpenEXR.
#include "engine/files/exr_file.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "engine/files/exr_bands.h"
#include "engine/files/exr_header.h"
#include "engine/schedule/workers.h"

namespace metamer {
namespace {

constexpr const char* band_count_attribute = "bandCount";  // of the film; where it has none, no such attribute
constexpr int film_layout_version = 1;
constexpr int rows_per_block = 16;                 // what one ZIP block of the format holds
constexpr int rows_per_read = 8 * rows_per_block;  // blocks that OpenEXR's threads unpack at one time
constexpr uint32_t limb_count = 4;                 // 32-bit limbs of a sum, the least significant first
constexpr uint32_t words_per_pixel = replicate_count * (3 * limb_count + 1);
const std::string settings_prefix = "metamer:";

// OpenEXR writes through this into the atomic file; what goes wrong there stops it.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(const std::string& path, AtomicFile& file) : OStream(path.c_str()), file_(file) {}
  void write(const char bytes[], int count) override { check(file_.write(bytes, static_cast<size_t>(count))); }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { check(file_.seek(position)); }

 private:
  static void check(const FileError& error) {
    if (error) throw Iex::IoExc(*error);
  }
  AtomicFile& file_;
};

constexpr const char *crop_x_attribute = "cropX", *crop_y_attribute = "cropY";

// Windows of a part of so many pixels: the picture lies in its frame, the sums of the film begin at 0, 0.
enum class Place : uint8_t { in_frame, at_origin };
Imf::Header make_header(uint32_t width, uint32_t height, const FrameWindow& frame, Place place) {
  const auto box = [](uint32_t x, uint32_t y, uint32_t w, uint32_t h) {
    const auto at = [](uint32_t i) { return static_cast<int>(i); };
    return Imath::Box2i(Imath::V2i(at(x), at(y)), Imath::V2i(at(x + w) - 1, at(y + h) - 1));
  };
  if (frame.full_width == 0) return {box(0, 0, width, height), box(0, 0, width, height)};
  const bool is_shifted = place == Place::in_frame;
  return {box(0, 0, frame.full_width, frame.full_height),
          box(is_shifted ? frame.x : 0, is_shifted ? frame.y : 0, width, height)};
}

int clamped_int(uint64_t value) { return static_cast<int>(std::min<uint64_t>(value, INT32_MAX)); }

void describe(Imf::Header& exr, const FrameHeader& header) {
  const auto v2f = [](const std::array<float, 2>& xy) { return Imath::V2f(xy[0], xy[1]); };
  const Chromaticities& c = header.chromaticities;
  Imf::addChromaticities(exr, Imf::Chromaticities(v2f(c.red), v2f(c.green), v2f(c.blue), v2f(c.white)));
  Imf::addWhiteLuminance(exr, header.white_luminance);
  exr.insert("software", Imf::StringAttribute(header.software));
  exr.insert("scene", Imf::StringAttribute(header.scene));
  exr.insert("seed", Imf::StringAttribute(std::to_string(header.seed)));
  if (header.window.full_width > 0) {
    exr.insert(crop_x_attribute, Imf::IntAttribute(static_cast<int>(header.window.x)));
    exr.insert(crop_y_attribute, Imf::IntAttribute(static_cast<int>(header.window.y)));
  }
  for (const auto& [name, value] : header.settings) exr.insert(settings_prefix + name, Imf::StringAttribute(value));
}

Imf::Header picture_header(const Picture& picture, const FrameHeader& header, const SampleTotals& samples,
                           bool has_film, const Film* spectral) {
  Imf::Header exr = make_header(picture.width, picture.height, header.window, Place::in_frame);
  exr.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : {"R", "G", "B"}) exr.channels().insert(name, Imf::Channel(Imf::FLOAT));
  describe(exr, header);
  if (samples.most > 0) {
    exr.insert("samples", Imf::IntAttribute(clamped_int(samples.most)));
    exr.insert("samplesFewest", Imf::IntAttribute(clamped_int(samples.fewest)));
  }
  exr.insert("checkpoint", Imf::StringAttribute(has_film ? "part 'film'" : "left out (preview only)"));
  if (spectral != nullptr && spectral->band_count() > 0) describe_bands(exr, spectral->band_count());
  exr.setName("picture");
  exr.setType(Imf::SCANLINEIMAGE);
  return exr;
}

std::string sum_channel(uint32_t replicate, int channel, uint32_t limb) {
  return fmt::format("replicate{}.{}.limb{}", replicate, "XYZ"[channel], limb);
}

// Every channel of the film part with its place in the words of a pixel.
std::vector<std::pair<std::string, uint32_t>> film_channels() {
  std::vector<std::pair<std::string, uint32_t>> channels;
  uint32_t word = 0;
  for (uint32_t r = 0; r < replicate_count; ++r) {
    for (int c = 0; c < 3; ++c)
      for (uint32_t limb = 0; limb < limb_count; ++limb) channels.emplace_back(sum_channel(r, c, limb), word++);
    channels.emplace_back(fmt::format("replicate{}.samples", r), word++);
  }
  return channels;
}

Imf::Header film_header(const Film& film, const FrameHeader& header) {
  Imf::Header exr = make_header(film.width(), film.height(), header.window, Place::at_origin);
  exr.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, word] : film_channels()) exr.channels().insert(name, Imf::Channel(Imf::UINT));
  describe(exr, header);
  exr.insert("filmLayoutVersion", Imf::IntAttribute(film_layout_version));
  if (film.band_count() > 0) exr.insert(band_count_attribute, Imf::IntAttribute(static_cast<int>(film.band_count())));
  exr.insert("invalidSamples", Imf::StringAttribute(std::to_string(film.invalid_samples())));
  exr.setName(film_part);
  exr.setType(Imf::SCANLINEIMAGE);
  return exr;
}

Imf::Header bands_header(const Film& film, const FrameHeader& header) {
  Imf::Header exr = make_header(film.width(), film.height(), header.window, Place::at_origin);
  exr.compression() = Imf::ZIP_COMPRESSION;
  add_band_sum_channels(exr, film.band_count());
  describe(exr, header);
  exr.setName(bands_part);
  exr.setType(Imf::SCANLINEIMAGE);
  return exr;
}

// A frame buffer over one block of rows of words, of which `first_row` is the first.
Imf::FrameBuffer block_buffer(std::vector<uint32_t>& words, uint32_t width, int first_row) {
  const size_t x_stride = words_per_pixel * sizeof(uint32_t), y_stride = x_stride * width;
  char* origin = reinterpret_cast<char*>(words.data()) - static_cast<ptrdiff_t>(y_stride) * first_row;
  Imf::FrameBuffer buffer;
  for (const auto& [name, word] : film_channels())
    buffer.insert(name, Imf::Slice(Imf::UINT, origin + word * sizeof(uint32_t), x_stride, y_stride));
  return buffer;
}

void pack(const PixelSums& sums, const PixelCounts& counts, uint32_t* words) {
  for (uint32_t r = 0; r < replicate_count; ++r) {
    for (const FixedSum sum : sums.xyz[r])
      for (uint32_t limb = 0; limb < limb_count; ++limb)
        *words++ = static_cast<uint32_t>(static_cast<unsigned __int128>(sum) >> (32 * limb));
    *words++ = counts.replicate[r];
  }
}

// False where the words cannot have come from a film: more samples than allowed, or a sum that they cannot reach.
bool unpack(const uint32_t* words, PixelSums& sums, PixelCounts& counts) {
  bool sound = true;
  for (uint32_t r = 0; r < replicate_count; ++r) {
    for (FixedSum& sum : sums.xyz[r]) {
      unsigned __int128 value = 0;
      for (uint32_t limb = 0; limb < limb_count; ++limb)
        value |= static_cast<unsigned __int128>(*words++) << (32 * limb);
      sum = static_cast<FixedSum>(value);
    }
    counts.replicate[r] = *words++;
    const FixedSum largest = to_fixed(sample_limit) * std::min(counts.replicate[r], max_samples_per_pixel);
    for (const FixedSum sum : sums.xyz[r]) sound = sound && sum <= largest && sum >= -largest;
  }
  return sound && counts.total() <= max_samples_per_pixel;
}

void write_film(Imf::OutputPart part, const Film& film) {
  std::vector<uint32_t> words(size_t{film.width()} * rows_per_block * words_per_pixel);
  for (uint32_t row = 0; row < film.height(); row += rows_per_block) {
    const uint32_t rows = std::min<uint32_t>(rows_per_block, film.height() - row);
    const size_t first = size_t{row} * film.width();
    for (size_t i = 0; i < size_t{rows} * film.width(); ++i)
      pack(film.sums()[first + i], film.counts()[first + i], words.data() + i * words_per_pixel);
    part.setFrameBuffer(block_buffer(words, film.width(), static_cast<int>(row)));
    part.writePixels(static_cast<int>(rows));
  }
}

bool parse_number(const std::string& digits, uint64_t& value) {
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return failed == std::errc() && end == digits.data() + digits.size();
}

int find_part(const Imf::MultiPartInputFile& file, const char* name) {
  for (int part = 0; part < file.parts(); ++part)
    if (file.header(part).hasName() && file.header(part).name() == name) return part;
  return -1;
}

// How many bands the film has, 0 for none; -1 where their part is missing, of another size or cut short.
int count_bands(const Imf::MultiPartInputFile& file, const Imf::Header& film) {
  const auto* count = film.findTypedAttribute<Imf::IntAttribute>(band_count_attribute);
  if (count == nullptr) return 0;
  const int part = find_part(file, bands_part);
  const bool is_whole = part >= 0 && file.header(part).dataWindow() == film.dataWindow() && file.partComplete(part);
  return is_whole && count->value() > 0 && count->value() <= static_cast<int>(max_band_count) ? count->value() : -1;
}

FileError read_film_pixels(const std::string& path, Imf::InputPart part, Film& film) {
  std::vector<uint32_t> words(size_t{film.width()} * std::min<uint32_t>(rows_per_read, film.height()) *
                              words_per_pixel);
  for (uint32_t row = 0; row < film.height(); row += rows_per_read) {
    const uint32_t rows = std::min<uint32_t>(rows_per_read, film.height() - row);
    part.setFrameBuffer(block_buffer(words, film.width(), static_cast<int>(row)));
    part.readPixels(static_cast<int>(row), static_cast<int>(row + rows - 1));
    const size_t first = size_t{row} * film.width();
    for (size_t i = 0; i < size_t{rows} * film.width(); ++i)
      if (!unpack(words.data() + i * words_per_pixel, film.sums()[first + i], film.counts()[first + i]))
        return fmt::format("{}: the film is damaged at pixel {},{}: its sums and sample counts do not agree", path,
                           i % film.width(), row + i / film.width());
  }
  return std::nullopt;
}

FileError read_checkpoint(const std::string& path, Film& film, FrameHeader& header, FilmBands bands) {
  const int threads = static_cast<int>(available_threads());
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  Imf::MultiPartInputFile file(path.c_str(), threads);
  const int number = find_part(file, film_part);
  if (number < 0)
    return fmt::format(
        "{}: holds no film part, so it is a picture but not a checkpoint; metamer render writes the film unless "
        "--preview-only is given",
        path);
  const Imf::Header& exr = file.header(number);
  const auto* version = exr.findTypedAttribute<Imf::IntAttribute>("filmLayoutVersion");
  if (version == nullptr || version->value() != film_layout_version)
    return fmt::format("{}: its film has layout version {}, {} was expected", path,
                       version == nullptr ? "none" : std::to_string(version->value()), film_layout_version);
  const Imath::Box2i window = exr.dataWindow();
  if (window.min != Imath::V2i(0, 0)) return fmt::format("{}: its film does not start at pixel 0,0", path);
  for (const auto& [name, word] : film_channels())
    if (const Imf::Channel* channel = exr.channels().findChannel(name);
        channel == nullptr || channel->type != Imf::UINT)
      return fmt::format("{}: its film has no UINT channel '{}'", path, name);
  if (!file.partComplete(number)) return fmt::format("{}: the film is incomplete, the file was cut short", path);
  const int band_count = bands == FilmBands::left_out ? 0 : count_bands(file, exr);
  if (band_count < 0) return fmt::format("{}: the bands of its film are missing or cut short", path);
  const int64_t columns = int64_t{window.max.x} + 1, rows = int64_t{window.max.y} + 1;
  if (const FileError error = check_frame_size(static_cast<uint64_t>(columns), static_cast<uint64_t>(rows),
                                               static_cast<uint32_t>(band_count)))
    return fmt::format("{}: {}", path, *error);
  Film read(static_cast<uint32_t>(columns), static_cast<uint32_t>(rows), static_cast<uint32_t>(band_count));
  uint64_t seed = 0, invalid_samples = 0;
  if (!parse_number(exr_text(exr, "seed"), seed) || !parse_number(exr_text(exr, "invalidSamples"), invalid_samples))
    return fmt::format("{}: the film's seed or number of refused samples is missing", path);
  read.set_invalid_samples(invalid_samples);
  if (const FileError error = read_film_pixels(path, Imf::InputPart(file, number), read)) return error;
  if (band_count > 0)
    if (const auto error = read_band_sums(Imf::InputPart(file, find_part(file, bands_part)), read))
      return fmt::format("{}: {}", path, *error);
  film = std::move(read);
  header = read_exr_header(exr);
  return std::nullopt;
}

int number_of(const Imf::Header& exr, const std::string& name) {
  const auto* attribute = exr.findTypedAttribute<Imf::IntAttribute>(name);
  return attribute == nullptr ? 0 : std::max(attribute->value(), 0);
}

// Reads the last rows of the last part: throws where the file ends before. Where its blocks begin is told at the front.
void touch_end(Imf::MultiPartInputFile& file) {
  const int last = file.parts() - 1;
  if (file.header(last).type() != Imf::SCANLINEIMAGE) return;
  const char* bytes = nullptr;
  int count = 0;
  Imf::InputPart(file, last).rawPixelData(file.header(last).dataWindow().max.y, bytes, count);
}

FileError read_part_0(const std::string& path, Picture& picture, FrameHeader& header, SampleTotals& samples) {
  const int threads = static_cast<int>(available_threads());
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  Imf::MultiPartInputFile file(path.c_str(), threads);
  for (int part = 0; part < file.parts(); ++part)
    if (!file.partComplete(part)) return fmt::format("{}: it is incomplete, the file was cut short", path);
  touch_end(file);
  const Imf::Header& exr = file.header(0);
  for (const char* name : {"R", "G", "B"})
    if (const Imf::Channel* channel = exr.channels().findChannel(name);
        channel == nullptr || channel->type != Imf::FLOAT || channel->xSampling != 1 || channel->ySampling != 1)
      return fmt::format("{}: its first part has no 32-bit float channel '{}'", path, name);
  const Imath::Box2i window = exr.dataWindow();
  const int64_t columns = int64_t{window.max.x} - window.min.x + 1, rows = int64_t{window.max.y} - window.min.y + 1;
  if (const FileError error = check_frame_size(static_cast<uint64_t>(columns), static_cast<uint64_t>(rows)))
    return fmt::format("{}: {}", path, *error);
  uint64_t seed = 0;
  if (!parse_number(exr_text(exr, "seed"), seed))
    return fmt::format("{}: its seed is missing; metamer render did not write it", path);
  FrameHeader read_as = read_exr_header(exr);
  Picture read{static_cast<uint32_t>(columns), static_cast<uint32_t>(rows), {}, {}, {}};
  Imf::FrameBuffer buffer;
  const std::array<std::pair<const char*, Column<float>*>, 3> channels = {
      {{"R", &read.r}, {"G", &read.g}, {"B", &read.b}}};
  for (const auto& [name, column] : channels) {
    column->resize(read.pixel_count());
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, column->data(), window));
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  picture = std::move(read);
  header = std::move(read_as);
  samples.fewest = static_cast<uint64_t>(number_of(exr, "samplesFewest"));
  samples.most = static_cast<uint64_t>(number_of(exr, "samples"));
  return std::nullopt;
}

}  // namespace

std::string exr_text(const Imf::Header& exr, const std::string& name) {
  const auto* attribute = exr.findTypedAttribute<Imf::StringAttribute>(name);
  return attribute == nullptr ? "" : attribute->value();
}

FrameHeader read_exr_header(const Imf::Header& exr) {
  FrameHeader header;
  header.software = exr_text(exr, "software");
  header.scene = exr_text(exr, "scene");
  if (Imf::hasChromaticities(exr)) {
    const Imf::Chromaticities& c = Imf::chromaticities(exr);
    header.chromaticities = {{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}};
  }
  for (auto it = exr.begin(); it != exr.end(); ++it)
    if (const std::string name = it.name(); name.starts_with(settings_prefix))
      header.settings.emplace_back(name.substr(settings_prefix.size()), exr_text(exr, name));
  if (uint64_t seed = 0; parse_number(exr_text(exr, "seed"), seed)) header.seed = seed;
  if (exr.findTypedAttribute<Imf::IntAttribute>(crop_x_attribute) != nullptr) {
    const Imath::Box2i& frame = exr.displayWindow();
    header.window = {static_cast<uint32_t>(number_of(exr, crop_x_attribute)),
                     static_cast<uint32_t>(number_of(exr, crop_y_attribute)), static_cast<uint32_t>(frame.max.x) + 1,
                     static_cast<uint32_t>(frame.max.y) + 1};
  }
  return header;
}

FileError read_picture(const std::string& path, Picture& picture, FrameHeader& header, SampleTotals& samples) {
  try {
    return read_part_0(path, picture, header, samples);
  } catch (const std::exception& error) {
    return fmt::format("{}: cannot be read: {}", path, error.what());
  }
}

FileError write_exr(const std::string& path, const Picture& picture, const FrameHeader& header,
                    const SampleTotals& samples, const Film* checkpoint, const Film* spectral) {
  AtomicFile file;
  if (const FileError error = file.open(path)) return error;
  try {
    std::vector<Imf::Header> parts = {picture_header(picture, header, samples, checkpoint != nullptr, spectral)};
    const bool has_band_sums = checkpoint != nullptr && checkpoint->band_count() > 0;
    if (has_band_sums) parts.push_back(bands_header(*checkpoint, header));
    if (checkpoint != nullptr) parts.push_back(film_header(*checkpoint, header));
    ExrStream stream(path, file);
    Imf::MultiPartOutputFile exr(stream, parts.data(), static_cast<int>(parts.size()));
    write_picture(Imf::OutputPart(exr, 0), picture, spectral);
    if (has_band_sums) write_band_sums(Imf::OutputPart(exr, 1), *checkpoint);
    if (checkpoint != nullptr) write_film(Imf::OutputPart(exr, has_band_sums ? 2 : 1), *checkpoint);
  } catch (const std::exception& error) {
    const FileError cause = file.error();
    return cause ? cause : fmt::format("{}: writing failed: {}", path, error.what());
  }
  return file.commit();
}

FileError read_film(const std::string& path, Film& film, FrameHeader& header, FilmBands bands) {
  try {
    return read_checkpoint(path, film, header, bands);
  } catch (const std::exception& error) {
    return fmt::format("{}: cannot be read: {}", path, error.what());
  }
}

}  // namespace metamer
