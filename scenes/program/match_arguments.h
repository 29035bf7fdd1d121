// The arguments of `metamer match` and `metamer metamers`.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "engine/spectrum/observers.h"
#include "scenes/program/values.h"

namespace metamer {

struct MatchArguments {
  std::string light;  // a wavelength, a name or a file
  std::string under;  // empty: the light shines by itself; else a light in which `light` is a reflectance
  Observer observer = Observer::stiles_burch1955;
  std::string output;  // .png; empty: none
  bool quiet = false;
};

struct ObserverTexts {
  std::string observer;
};

struct MetamersArguments {
  std::string base;          // a reflectance between the two: a name, a file, or a grey from 0 to 1
  std::string same = "D65";  // the light in which they look alike
  std::string apart = "A";   // the one in which they do not
  Observer observer = Observer::cie1931;
  std::string output;  // .json; empty: none
};

void add_match(CLI::App& app, MatchArguments& arguments, ObserverTexts& texts);
void parse_match(const CLI::App& match, const ObserverTexts& texts, MatchArguments& arguments, Mistakes& mistakes);

void add_metamers(CLI::App& app, MetamersArguments& arguments, ObserverTexts& texts);
void parse_metamers(const CLI::App& metamers, const ObserverTexts& texts, MetamersArguments& arguments,
                    Mistakes& mistakes);

}  // namespace metamer
