// The embedded numbers against a second copy, value by value, and against published values and check-sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/spectrum/embedded_data.h"
#include "engine/spectrum/observers.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

const std::filesystem::path shared_data = std::filesystem::path(METAMER_SOURCE_DIR) / "../shared/data";

std::vector<std::string> split(const std::string& line, size_t limit = 1000) {
  std::vector<std::string> fields;
  size_t begin = 0;
  while (fields.size() + 1 < limit) {
    const size_t end = line.find(',', begin);
    if (end == std::string::npos) break;
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  fields.push_back(line.substr(begin));
  return fields;
}

std::vector<std::string> read_lines(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// Tables that the shared data does not have; what they hold is checked below against published numbers.
bool is_of_our_own(std::string_view name) {
  constexpr std::string_view names[] = {"illuminant/FL3", "illuminant/FL4", "illuminant/FL5",  "illuminant/FL6",
                                        "illuminant/FL8", "illuminant/FL9", "illuminant/FL10", "nk/CuZn",
                                        "nk/MgO",         "nk/TiO2"};
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

TEST(SpectralData, EqualsTheSharedTablesValueByValue) {
  if (!std::filesystem::exists(shared_data)) GTEST_SKIP() << shared_data << " is absent";
  size_t compared = 0;
  for (const DataTable& table : embedded_data()) {
    if (table.name.starts_with("dispersion/") || table.name.starts_with("sky/") || table.name.starts_with("media/") ||
        is_of_our_own(table.name))
      continue;
    SCOPED_TRACE(table.name);
    const auto lines = read_lines(shared_data / (std::string(table.name) + ".csv"));
    ASSERT_EQ(lines.size(), table.rows() + 2);
    EXPECT_EQ(lines[0], "# " + std::string(table.source));
    EXPECT_EQ(lines[1], table.header);
    for (size_t row = 0; row < table.rows(); ++row) {
      const auto fields = split(lines[row + 2]);
      ASSERT_EQ(fields.size(), table.columns);
      for (size_t column = 0; column < table.columns; ++column) {
        EXPECT_EQ(std::stod(fields[column]), table.at(row, column)) << "row " << row << " column " << column;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 12000u);
}

TEST(SpectralData, DispersionEqualsTheSharedTableValueByValue) {
  if (!std::filesystem::exists(shared_data)) GTEST_SKIP() << shared_data << " is absent";
  const auto lines = read_lines(shared_data / "dispersion.csv");
  size_t media = 0;
  for (size_t i = 3; i < lines.size(); ++i, ++media) {
    const auto fields = split(lines[i], 11);
    SCOPED_TRACE(fields[0]);
    const DataTable* table = find_embedded_data("dispersion/" + fields[0]);
    ASSERT_NE(table, nullptr);
    size_t terms = 0;
    for (size_t term = 0; term < 4 && !fields[2 + 2 * term].empty(); ++term, ++terms) {
      EXPECT_EQ(std::stod(fields[2 + 2 * term]), table->at(term, 0));
      EXPECT_EQ(std::stod(fields[3 + 2 * term]), table->at(term, 1));
    }
    EXPECT_EQ(terms, table->rows());
  }
  EXPECT_EQ(media, 11u);
}

TEST(SpectralData, EverySourceIsNamed) {
  EXPECT_EQ(embedded_data().size(), 5u + 20u + 13u + 14u + 1u + 7u + 2u);
  for (const DataTable& table : embedded_data()) EXPECT_GT(table.source.size(), 20u) << table.name;
}

// CIE 15:2004 tables T.4 and T.5: the published values and, of the 1 nm tables over 360..830 nm, the sums.
TEST(SpectralData, ObserversHaveThePublishedPeaksAndSums) {
  EXPECT_EQ(observer_value(Observer::cie1931, 555.0)[1], 1.0);
  EXPECT_EQ(observer_value(Observer::cie1931, 547.0)[1], 0.9874182);  // mistyped for years elsewhere
  const auto sums = [](Observer observer) { return observer_table(observer).integrals; };
  EXPECT_NEAR(sums(Observer::cie1931)[0], 106.865469, 1e-6);
  EXPECT_NEAR(sums(Observer::cie1931)[1], 106.856917, 1e-6);
  EXPECT_NEAR(sums(Observer::cie1931)[2], 106.892251, 1e-6);
  EXPECT_NEAR(sums(Observer::cie1964)[0], 116.648519, 1e-6);
  EXPECT_NEAR(sums(Observer::cie1964)[1], 116.661877, 1e-6);
  EXPECT_NEAR(sums(Observer::cie1964)[2], 116.673980, 1e-6);
}

// CIE 170-2:2015: the functions are normalised to equal integrals, and to a maximum of ybar of 1 (between 1 nm nodes).
TEST(SpectralData, ConeFundamentalObserversHaveEqualIntegrals) {
  for (const Observer observer : {Observer::cie2015_2, Observer::cie2015_10}) {
    const ObserverTable& table = observer_table(observer);
    EXPECT_NEAR(table.integrals[0] / table.integrals[1], 1.0, 1e-6);
    EXPECT_NEAR(table.integrals[2] / table.integrals[1], 1.0, 1e-6);
    EXPECT_NEAR(*std::max_element(table.matching[1].begin(), table.matching[1].end()), 1.0, 1e-4);
  }
}

// Stiles and Burch 1955: at a primary only that one is needed, so the other two functions vanish there.
TEST(SpectralData, StilesAndBurchVanishAtTheOtherPrimaries) {
  const double primaries_nm[] = {645.16, 526.32, 444.44};
  for (size_t own = 0; own < 3; ++own) {
    const auto value = observer_value(Observer::stiles_burch1955, primaries_nm[own]);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(value[c], c == own ? value[own] : 0.0, 0.012);
    EXPECT_GT(value[own], 0.5);
  }
}

TEST(Observers, AreFoundByNameAndZeroOutsideTheRange) {
  for (size_t i = 0; i < observer_count; ++i) {
    const auto observer = static_cast<Observer>(i);
    EXPECT_EQ(find_observer(observer_name(observer)), observer);
    EXPECT_EQ(observer_value(observer, 359.0)[1], 0.0);
    EXPECT_EQ(observer_value(observer, 831.0)[1], 0.0);
    EXPECT_EQ(observer_table(observer).columns[lambda_stride + lambda_count],
              static_cast<float>(observer_value(observer, 830.0)[1]));
  }
  EXPECT_FALSE(find_observer("cie1932"));
}

// refractiveindex.info and the catalogues, at the sodium line 589.3 nm and the helium d line 587.56 nm.
TEST(SpectralData, DispersionMeetsPublishedIndices) {
  const auto index = [](const char* medium, double lambda_nm) {
    return sellmeier_index(require_embedded_data(std::string("dispersion/") + medium), lambda_nm);
  };
  EXPECT_NEAR(index("N-BK7", 587.5618), 1.51680, 5e-6);
  EXPECT_NEAR(index("N-SF11", 587.5618), 1.78472, 5e-6);
  EXPECT_NEAR(index("N-SF66", 587.5618), 1.92286, 5e-6);
  EXPECT_NEAR(index("SF10", 587.5618), 1.72825, 5e-6);
  EXPECT_NEAR(index("N-LAK33B", 587.5618), 1.75500, 5e-6);
  EXPECT_NEAR(index("N-FK51A", 587.5618), 1.48656, 5e-6);
  EXPECT_NEAR(index("N-BAF10", 587.5618), 1.67003, 5e-6);
  EXPECT_NEAR(index("N-LASF9", 587.5618), 1.85025, 5e-6);
  EXPECT_NEAR(index("SF5", 587.5618), 1.67270, 5e-6);
  EXPECT_NEAR(index("water", 589.3), 1.33335, 1e-5);
  EXPECT_NEAR(index("diamond", 589.3), 2.41726, 1e-5);
  EXPECT_NEAR(index("fused-silica", 589.3), 1.45840, 1e-5);
  EXPECT_NEAR(index("PMMA", 589.3), 1.49054, 1e-5);
  EXPECT_NEAR(index("sapphire-o", 589.3), 1.7681, 5e-5);
}

// CIE 15:2004, table T.7: chromaticities of the fluorescent lamps from their 5 nm tables.
TEST(SpectralData, FluorescentLampsHaveThePublishedChromaticities) {
  const auto expect_xy = [](const char* lamp, double x, double y) {
    const DataTable& table = require_embedded_data(std::string("illuminant/") + lamp);
    double sums[3] = {};
    for (size_t row = 0; row < table.rows(); ++row)
      for (size_t c = 0; c < 3; ++c)
        sums[c] += table.at(row, 1) * observer_value(Observer::cie1931, table.at(row, 0))[c];
    EXPECT_NEAR(sums[0] / (sums[0] + sums[1] + sums[2]), x, 5.1e-5) << lamp;
    EXPECT_NEAR(sums[1] / (sums[0] + sums[1] + sums[2]), y, 5.1e-5) << lamp;
  };
  expect_xy("FL2", 0.3721, 0.3751);
  expect_xy("FL3", 0.4091, 0.3941);
  expect_xy("FL4", 0.4402, 0.4031);
  expect_xy("FL5", 0.3138, 0.3452);
  expect_xy("FL6", 0.3779, 0.3882);
  expect_xy("FL8", 0.3458, 0.3586);
  expect_xy("FL9", 0.3741, 0.3727);
  expect_xy("FL10", 0.3458, 0.3588);
}

// MgO at the sodium line, Stephens & Malitson 1952; rutile's ordinary ray there, Devore 1951; brass, Querry 1985.
TEST(SpectralData, OxidesAndBrassHaveThePublishedIndices) {
  const auto magnesia = *metal_index("MgO"), rutile = *metal_index("TiO2"), brass = *metal_index("CuZn");
  EXPECT_NEAR(interpolate(magnesia.eta, 589.3), 1.7374, 1e-4);
  EXPECT_NEAR(interpolate(rutile.eta, 589.3), 2.6129, 2e-4);
  EXPECT_EQ(interpolate(magnesia.kappa, 500), 0);
  EXPECT_EQ(interpolate(rutile.kappa, 500), 0);
  EXPECT_NEAR(interpolate(brass.eta, 590), 0.460, 1e-9);
  EXPECT_NEAR(interpolate(brass.kappa, 590), 3.159, 1e-9);
}

// Johnson and Christy 1972, table I: photon energies of 2.26 and 2.01 eV.
TEST(SpectralData, NobleMetalsHaveJohnsonAndChristysIndices) {
  const auto gold = *metal_index("Au");
  EXPECT_NEAR(interpolate(gold.eta, 548.6), 0.43, 2e-3);
  EXPECT_NEAR(interpolate(gold.kappa, 548.6), 2.455, 5e-3);
  const auto copper = *metal_index("Cu");
  EXPECT_NEAR(interpolate(copper.eta, 616.8), 0.30, 3e-3);
  EXPECT_NEAR(interpolate(copper.kappa, 616.8), 3.205, 5e-3);
}

}  // namespace
}  // namespace metamer
