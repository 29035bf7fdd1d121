// What is fuzzed: each reader as a function of bytes. `./run fuzz` gives them to libFuzzer (entry.cpp), replay_test.cpp
// gives them the kept corpora. Inputs cannot name files outside of a scratch folder.
#pragma once
#include <string_view>

namespace metamer::fuzz {

// Each stops the program where the reader breaks what its header promises, beside what the sanitizers find.

void tokens(std::string_view input);  // pbrt's words, numbers and parameter lists
// The whole pbrt reader. Lines `#= part.pbrt`, `more.pbrt`, `mesh.ply`, `table.spd`, `part.pbrt.gz` or `mesh.ply.gz`
// begin what is in that file beside the scene; an image map.tga and a square sky.pfm are always there.
void pbrt(std::string_view input);
void ply(std::string_view input);   // a PLY file
void gzip(std::string_view input);  // a compressed file
// A table of wavelengths and values: as .spd file, in a scene, and as the program's own commands read it.
void spectra(std::string_view input);
void native(std::string_view input);  // our own JSON, beside mesh.ply, map.tga and sky.pfm

struct Target {
  std::string_view name;
  void (*read)(std::string_view);
};
inline constexpr Target targets[] = {{"tokens", tokens}, {"pbrt", pbrt},       {"ply", ply},
                                     {"gzip", gzip},     {"spectra", spectra}, {"native", native}};

}  // namespace metamer::fuzz
