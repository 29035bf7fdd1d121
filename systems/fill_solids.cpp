#include <fmt/format.h>

#include <map>

#include "systems/freeze.h"

namespace metamer {
namespace {

// The medium with that volume in it; equal ones are one.
uint32_t filled_medium(uint32_t medium, uint32_t volume, MediumColumns& media) {
  for (uint32_t row = 1; row < media.eta.size(); ++row)
    if (media.eta[row] == media.eta[medium] && media.kappa[row] == media.kappa[medium] &&
        media.priority[row] == media.priority[medium] && media.volume[row] == volume)
      return row;
  for (Column<uint32_t>* column : {&media.eta, &media.kappa, &media.priority, &media.dispersive})
    column->push_back(uint32_t{(*column)[medium]});
  media.volume.push_back(volume);
  return static_cast<uint32_t>(media.eta.size() - 1);
}

// The same material around another medium.
uint32_t repeat_dielectric(uint32_t row, ShadeKind kind, uint32_t medium, World& world) {
  DielectricColumns& t = world.dielectric;
  for (Column<uint32_t>* column : {&t.eta, &t.kappa, &t.schlick, &t.dispersive, &t.partly_opaque, &t.medium,
                                   &t.alpha_texture[0], &t.alpha_texture[1], &t.is_absolute})
    column->push_back(uint32_t{(*column)[row]});
  for (Column<float>* column : {&t.alpha_x, &t.alpha_y, &t.thickness}) column->push_back(float{(*column)[row]});
  const auto repeated = static_cast<uint32_t>(t.eta.size() - 1);
  t.medium[repeated] = medium;
  Column<uint32_t>& bumps = world.bumps[static_cast<size_t>(kind)];
  if (row < bumps.size()) {
    const uint32_t bump = bumps[row];
    while (bumps.size() <= repeated) bumps.push_back(no_index);
    bumps[repeated] = bump;
  }
  return repeated;
}

}  // namespace

void fill_solids(std::span<const VolumeSides> sides, std::vector<MaterialRow>& materials, World& world,
                 Diagnostics& diagnostics) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> known;  // row and volume: row with it
  for (size_t entity = 0; entity < std::min(sides.size(), materials.size()); ++entity) {
    MaterialRow& material = materials[entity];
    if (material.kind != ShadeKind::dielectric && material.kind != ShadeKind::rough_dielectric) continue;
    const uint32_t medium = world.dielectric.medium[material.row], volume = sides[entity].inside;
    if (medium == 0 || volume == keeps_volume) continue;
    const auto [place, is_new] = known.try_emplace({material.row, volume}, 0);
    if (is_new) {
      const uint32_t filled = filled_medium(medium, volume, world.media);
      place->second = repeat_dielectric(material.row, material.kind, filled, world);
    }
    material.row = place->second;
  }
  if (world.media.eta.size() > largest_medium + 1)
    diagnostics.error({}, fmt::format("the scene has {} media that paths follow; at most {} are possible",
                                      world.media.eta.size() - 1, largest_medium));
}

}  // namespace metamer
