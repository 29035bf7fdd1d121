// The values of flags. What is wrong becomes a line of `mistakes`, and the result is nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace metamer {

using Mistakes = std::vector<std::string>;

// A whole number in decimal digits, least to most.
std::optional<uint32_t> parse_count(std::string_view flag, std::string_view text, uint32_t least, uint32_t most,
                                    Mistakes& mistakes);

// A number within [least, most]; a leading + is allowed.
std::optional<float> parse_real(std::string_view flag, std::string_view text, float least, float most,
                                Mistakes& mistakes);

// WIDTHxHEIGHT, pixels, each from 1. Whether there is memory for them is asked later.
std::optional<std::pair<uint32_t, uint32_t>> parse_size(std::string_view flag, std::string_view text,
                                                        Mistakes& mistakes);

}  // namespace metamer
