// The values of flags. What is wrong becomes a line of `mistakes`, and the result is nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace metamer {

using Mistakes = std::vector<std::string>;

// A whole number in decimal digits, least to most.
std::optional<uint32_t> parse_count(std::string_view flag, std::string_view text, uint32_t least, uint32_t most,
                                    Mistakes& mistakes);

// Bytes, of at least so many: a whole number with K, M, G or T (or KiB ...), powers of 1024, or without.
std::optional<uint64_t> parse_bytes(std::string_view flag, std::string_view text, uint64_t least, Mistakes& mistakes);

// A number within [least, most]; a leading + is allowed. `or_else` is told where it is wrong: " or auto".
std::optional<float> parse_real(std::string_view flag, std::string_view text, float least, float most,
                                Mistakes& mistakes, std::string_view or_else = {});

// The place of a name among `names`, in lower or upper case.
std::optional<size_t> parse_name(std::string_view flag, std::string_view text, std::span<const std::string_view> names,
                                 Mistakes& mistakes);

// ASCII letters only.
std::string in_lower_case(std::string_view text);

// WIDTHxHEIGHT, pixels, each from 1. Whether there is memory for them is asked later.
std::optional<std::pair<uint32_t, uint32_t>> parse_size(std::string_view flag, std::string_view text,
                                                        Mistakes& mistakes);

}  // namespace metamer
