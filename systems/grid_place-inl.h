// What grids say of a place within a volume.
#if defined(METAMER_SYSTEMS_GRID_PLACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_GRID_PLACE_INL_H_
#undef METAMER_SYSTEMS_GRID_PLACE_INL_H_
#else
#define METAMER_SYSTEMS_GRID_PLACE_INL_H_
#endif

#include "systems/blackbody-inl.h"
#include "systems/grid_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// What is at a collision, per metre on four wavelengths; all of it at most the majorant.
struct Matter {
  VF absorption[4], scattering[4], extinction[4];
};

class Place {
 public:
  Place(const World& world, const GridVolume& volume, const Vec3& cells, VU number)
      : world_(world), volume_(volume), cells_(cells) {
    if (!volume.stochastic) return;
    const VU first = hash_u32(hn::Xor(number, splat_u(0x2545f491u))), second = hash_u32(hn::Add(first, splat_u(1)));
    chance_ = {unit_float(first), unit_float(second), unit_float(hash_u32(hn::Add(second, splat_u(1))))};
  }

  VF density() const { return volume_.density.is_used() ? number(volume_.density) : splat(1.0f); }
  // values * what the grid says of each of its channels.
  void add_up(const GridUse& use, const RayLanes& lanes, size_t field, VF factor, VF out[4]) const {
    if (use.channels == 3) {
      VF rgb[3];
      look<3>(use, rgb);
      for (size_t j = 0; j < 4; ++j) {
        VF sum = hn::Mul(rgb[0], lanes.get(field + j));
        sum = hn::MulAdd(rgb[1], lanes.get(field + 4 + j), sum);
        out[j] = hn::Mul(factor, hn::MulAdd(rgb[2], lanes.get(field + 8 + j), sum));
      }
      return;
    }
    if (use.channels == 1) factor = hn::Mul(factor, number(use));
    for (size_t j = 0; j < 4; ++j) out[j] = hn::Mul(factor, lanes.get(field + j));
  }

  Matter matter(const RayLanes& lanes, VF majorant) const {
    Matter m;
    const VF d = density();
    add_up(volume_.sigma_a, lanes, ray_absorption, hn::Mul(d, splat(1 / std::max(volume_.sigma_a_most, FLT_MIN))),
           m.absorption);
    add_up(volume_.sigma_s, lanes, ray_scattering, hn::Mul(d, splat(1 / std::max(volume_.sigma_s_most, FLT_MIN))),
           m.scattering);
    for (size_t j = 0; j < 4; ++j) {
      const VF most = hn::Mul(majorant, lanes.get(ray_extinction + j));
      m.extinction[j] = hn::Min(hn::Add(m.absorption[j], m.scattering[j]), most);
    }
    return m;
  }

  // L_e, W m^-2 sr^-1 nm^-1.
  void emission(const RayLanes& lanes, VF out[4]) const {
    add_up(volume_.emission, lanes, ray_emission, splat(1.0f), out);
    if (!volume_.temperature.is_used()) return;
    const VF kelvin = hn::Mul(hn::Sub(number(volume_.temperature), splat(volume_.temperature_offset)),
                              splat(volume_.temperature_scale));
    const MF shines = hn::Gt(kelvin, splat(100.0f));
    const VF warm = hn::IfThenElse(shines, kelvin, splat(100.0f));
    const VF peak = volume_.peak_is_one ? splat(1.0f) : blackbody_peak(warm);
    for (size_t j = 0; j < 4; ++j) {
      const VF shape = blackbody(world_, warm, lanes.get(ray_lambda + j));
      out[j] = hn::IfThenElseZero(shines, hn::Mul(out[j], hn::Mul(peak, shape)));
    }
  }

 private:
  template <int channels>
  void look(const GridUse& use, VF out[channels]) const {
    const GridRow& row = world_.grids.rows[use.grid];
    const Vec3 p = affine_point(use.to_index, cells_);
    if (volume_.stochastic)
      grid_stochastic<channels>(world_.grids, row, p, chance_, out);
    else
      grid_trilinear<channels>(world_.grids, row, p, out);
  }
  VF number(const GridUse& use) const {
    VF value[1];
    look<1>(use, value);
    return value[0];
  }

  const World& world_;
  const GridVolume& volume_;
  Vec3 cells_, chance_;
};

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
