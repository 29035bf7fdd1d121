// Spectra as the native format says them, so that reading gives the same row of SpectrumSet to the last bit.
#pragma once
#include <map>
#include <string>

#include "engine/spectrum/spectrum_set.h"
#include "scenes/native/json_text.h"

namespace metamer {

// Constants become numbers and built-in spectra their names. What has 471 samples goes to the file's "spectra", once,
// and is named where it is used.
class SpectrumWriter {
 public:
  explicit SpectrumWriter(const SpectrumSet& set) : set_(set) {}

  JsonText write(SpectrumId id);
  // Where an rgb of up to six decimals is a reflectance of exactly this spectrum, that; else as above.
  JsonText write_reflectance(SpectrumId id);
  // All that was written so far refers to; empty if to nothing.
  const JsonText& definitions() const { return definitions_; }

 private:
  // What a table is called, and the scale of the spectrum of that name.
  struct NamedTable {
    std::string name;
    float scale;
  };
  const NamedTable& named_table(uint32_t table);
  NamedTable define(const std::string& content);

  const SpectrumSet& set_;
  std::map<uint32_t, NamedTable> tables_;  // of the set, as far as they were asked for
  JsonText definitions_ = JsonText::object().break_lines();
  size_t defined_ = 0;
};

}  // namespace metamer
