// Standard observers: colour-matching functions at 1 nm, 360 to 830 nm.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "engine/spectrum/samples.h"

namespace metamer {

// The lumens per watt by which every photometric quantity here is scaled.
inline constexpr double luminous_efficacy = 683.0;

enum class Observer : uint8_t { cie1931, cie1964, cie2015_2, cie2015_10, stiles_burch1955 };
inline constexpr size_t observer_count = 5;

// xbar, ybar, zbar; of Stiles & Burch rbar, gbar, bbar, whose primaries are lamps of 645.16, 526.32 and 444.44 nm.
struct ObserverTable {
  std::array<Samples, 3> matching;
  // The same in single precision, one function after the other, `lambda_stride` apart; entries past 830 nm repeat
  // that at 830 nm.
  alignas(64) std::array<float, 3 * lambda_stride> columns;
  // Integrals of the three over 360..830 nm.
  std::array<double, 3> integrals;
};

// Below 390 nm (2015, Stiles & Burch) and above 730 nm (Stiles & Burch), where nothing is tabulated, zero. The 5 nm
// table of Stiles & Burch is interpolated linearly.
const ObserverTable& observer_table(Observer observer);

// The three functions at lambda_nm, linear between table entries, zero outside 360..830.
std::array<double, 3> observer_value(Observer observer, double lambda_nm);

// First and last wavelength of its table.
struct WavelengthRange {
  double first_nm, last_nm;
};
WavelengthRange observer_range(Observer observer);

// "cie1931", "cie1964", "cie2015-2", "cie2015-10", "stiles-burch1955".
std::span<const std::string_view> observer_names();
std::string_view observer_name(Observer observer);
std::optional<Observer> find_observer(std::string_view name);

}  // namespace metamer
