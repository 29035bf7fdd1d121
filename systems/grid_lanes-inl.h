// Rays on their way through one volume of grids, a vector of them at a time: what is known of each, and how the next
// one takes the place of one that has arrived, so that vectors stay full.
#if defined(METAMER_SYSTEMS_GRID_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_GRID_LANES_INL_H_
#undef METAMER_SYSTEMS_GRID_LANES_INL_H_
#else
#define METAMER_SYSTEMS_GRID_LANES_INL_H_
#endif

#include "systems/grid_lookup-inl.h"
#include "systems/grid_track.h"
#include "systems/volumes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// The numbers of a ray. Lengths are metres along it from `start`, where it enters; depths are integrals of the majorant
// over metres, before it is multiplied by an extinction.
enum RayField : size_t {
  ray_at = 0,
  ray_end,
  ray_left,                      // depth to the next collision
  ray_depth,                     // since the last one
  ray_lead,                      // the extinction that collisions are drawn with, per metre where the majorant is 1
  ray_cell,                      // three: whole numbers
  ray_bias = ray_cell + 3,       // three: (cell + bias) times inverse is where the ray leaves the cell
  ray_inverse = ray_bias + 3,    // three: of the direction, cells
  ray_origin = ray_inverse + 3,  // three: where it enters, cells
  ray_direction = ray_origin + 3,
  ray_passes = ray_direction + 3,        // four: what throughput is multiplied by
  ray_share = ray_passes + 4,            // four: PathStream::share
  ray_radiance = ray_share + 4,          // four: what glows, before throughput
  ray_lambda = ray_radiance + 4,         // four, nm
  ray_extinction = ray_lambda + 4,       // four, per metre where the majorant is 1
  ray_absorption = ray_extinction + 4,   // three times four, a channel of the grid each; one channel: the first
  ray_scattering = ray_absorption + 12,  // the same
  ray_emission = ray_scattering + 12,    // the same: W m^-2 sr^-1 nm^-1
  ray_start = ray_emission + 12,
  ray_row,    // of the streams
  ray_key,    // of its random numbers
  ray_event,  // collisions so far
  ray_fields
};

struct RayLanes {
  alignas(64) float words[ray_fields][hn::MaxLanes(FloatTag())];

  VF get(size_t field) const { return hn::Load(FloatTag(), words[field]); }
  VU get_u(size_t field) const { return hn::BitCast(UintTag(), get(field)); }
  Vec3 get3(size_t field) const { return {get(field), get(field + 1), get(field + 2)}; }
  void set(size_t field, VF v) { hn::Store(v, FloatTag(), words[field]); }
  void set_u(size_t field, VU v) { set(field, hn::BitCast(FloatTag(), v)); }
  void set3(size_t field, const Vec3& v) {
    set(field, v.x);
    set(field + 1, v.y);
    set(field + 2, v.z);
  }
  uint32_t word(size_t field, int lane) const {
    uint32_t result;
    std::memcpy(&result, &words[field][lane], sizeof(result));
    return result;
  }
};

HWY_INLINE uint32_t bits_of(MF mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(FloatTag(), mask, bits);
  return bits[0] | uint32_t{bits[1]} << 8;
}
HWY_INLINE MF mask_of(uint32_t set) {
  const uint8_t bits[8] = {static_cast<uint8_t>(set), static_cast<uint8_t>(set >> 8)};
  return hn::LoadMaskBits(FloatTag(), bits);
}

// Random numbers of a ray's n-th collision; hashes, as what comes of them jumps from one voxel to the next.
struct CollisionNumbers {
  VU first, second;
};
HWY_INLINE CollisionNumbers collision_numbers(VU key, VU event) {
  const VU first = hash_u32(hn::Add(key, hn::Mul(event, splat_u(0x9e3779b9u))));
  return {first, hash_u32(hn::Xor(first, splat_u(0x68bc21ebu)))};
}
// -log(1 - u): an exponential of mean 1.
HWY_INLINE VF exponential(VU number) { return hn::Neg(log(hn::Sub(splat(1.0f), unit_float(number)))); }
HWY_INLINE VF divide_or_infinity(VF a, VF b) {
  const MF above = hn::Gt(b, hn::Zero(FloatTag()));
  return hn::IfThenElse(above, hn::Div(a, hn::IfThenElse(above, b, a)), hn::Inf(FloatTag()));
}

// Where a ray is between two corners of a box: [near, far].
HWY_INLINE void clip(const Vec3& origin, const Vec3& direction, const Vec3& lower, const Vec3& upper, VF* near,
                     VF* far) {
  const auto axis = [&](VF o, VF d, VF low, VF high) {
    const VF inverse = safe_reciprocal(d);
    const VF a = hn::Mul(hn::Sub(low, o), inverse), b = hn::Mul(hn::Sub(high, o), inverse);
    *near = hn::Max(*near, hn::Min(a, b));
    *far = hn::Min(*far, hn::Max(a, b));
  };
  axis(origin.x, direction.x, lower.x, upper.x);
  axis(origin.y, direction.y, lower.y, upper.y);
  axis(origin.z, direction.z, lower.z, upper.z);
}

HWY_INLINE Vec3 splat3(const float v[3]) { return {splat(v[0]), splat(v[1]), splat(v[2])}; }

// The listed rays of a volume, a vector of them ready to take a lane.
class RayQueue {
 public:
  RayQueue(const World& world, uint32_t volume, const VolumeRays& rays, const uint32_t* order, uint32_t count)
      : world_(world),
        grid_(world.grid_volumes[world.volumes.grid[volume]]),
        volume_(volume),
        rays_(rays),
        order_(order),
        count_(count),
        samples_leads_(rays.scatters && world.volumes.scatters[volume] != 0) {}

  // Gives each of `free` lanes a ray; the lanes that got one.
  uint32_t refill(uint32_t free, RayLanes& lanes) {
    uint32_t filled = 0;
    for (; free != 0; free &= free - 1) {
      while (ready_ == 0 && next_ < count_) prepare();
      if (ready_ == 0) break;
      const int to = __builtin_ctz(free), from = __builtin_ctz(ready_);
      for (size_t field = 0; field < ray_fields; ++field) lanes.words[field][to] = queue_.words[field][from];
      ready_ &= ready_ - 1;
      filled |= free & -free;
    }
    return filled;
  }

 private:
  // The next vector. Rays that miss the grids are done.
  HWY_NOINLINE void prepare() {
    const FloatTag d;
    const VU ordered = load(order_, next_);
    next_ += static_cast<uint32_t>(lane_count());
    const auto listed = hn::Ne(ordered, splat_u(dead_lane));
    const VI row = as_index(hn::IfThenElseZero(listed, ordered));
    const Vec3 origin = gather(rays_.paths.origin, row), direction = gather(rays_.paths.direction, row);
    VF start = gather(rays_.hits.passed, row), end = gather(rays_.hits.distance, row);
    clip(affine_point(grid_.to_local, origin), affine_vector(grid_.to_local, direction), splat3(grid_.lower),
         splat3(grid_.upper), &start, &end);
    const Vec3 cells_origin = affine_point(grid_.to_cells, origin);
    const Vec3 cells_direction = affine_vector(grid_.to_cells, direction);
    const float sides[3] = {static_cast<float>(grid_.cells[0]), static_cast<float>(grid_.cells[1]),
                            static_cast<float>(grid_.cells[2])};
    const float corner[3] = {0, 0, 0};
    clip(cells_origin, cells_direction, splat3(corner), splat3(sides), &start, &end);
    const VF length = hn::Sub(end, start);
    queue_.set(ray_at, hn::Zero(d));
    queue_.set(ray_end, length);
    queue_.set(ray_start, start);
    queue_.set(ray_depth, hn::Zero(d));
    place(mul_add(cells_direction, start, cells_origin), cells_direction, sides);
    const VU pixel_seed = gather(rays_.paths.pixel_seed, row);
    const VU key = hash_combine(hash_combine(pixel_seed, splat_u(rays_.key)), gather(rays_.paths.index, row));
    queue_.set_u(ray_key, key);
    queue_.set_u(ray_event, splat_u(1));
    queue_.set_u(ray_row, hn::BitCast(UintTag(), row));
    const VF lead = coefficients(row);
    const VF depth =
        samples_leads_ ? gather(rays_.hits.depth_left, row) : exponential(collision_numbers(key, splat_u(0)).second);
    queue_.set(ray_lead, lead);
    queue_.set(ray_left, divide_or_infinity(depth, lead));
    ready_ = bits_of(hn::And(float_mask(listed), hn::Gt(length, hn::Zero(d))));
  }

  void place(const Vec3& p, const Vec3& direction, const float sides[3]) {
    const auto axis = [&](size_t i, VF x, VF along) {
      const VF inverse = safe_reciprocal(along);
      const VF ahead = hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(FloatTag())), splat(1.0f));
      queue_.set(ray_cell + i, hn::Floor(clamp(x, 0.0f, sides[i] - 1)));
      queue_.set(ray_bias + i, hn::Sub(ahead, x));
      queue_.set(ray_inverse + i, inverse);
    };
    axis(0, p.x, direction.x);
    axis(1, p.y, direction.y);
    axis(2, p.z, direction.z);
    queue_.set3(ray_origin, p);
    queue_.set3(ray_direction, direction);
  }

  // On the four wavelengths of each ray. Returns the extinction that leads.
  VF coefficients(VI row) {
    VF lambda_nm[4];
    for (size_t j = 0; j < 4; ++j) lambda_nm[j] = gather(rays_.paths.lambda_nm[j], row);
    const VolumeCoefficients c = volume_coefficients(world_, splat_u(volume_), lambda_nm);
    VF absorption[4], scattering[4], glow[4];
    const VF one = splat(1.0f), zero = hn::Zero(FloatTag());
    VF most = zero;
    for (size_t j = 0; j < 4; ++j) {
      absorption[j] = hn::Mul(c.absorption[j], splat(grid_.sigma_a_most));
      scattering[j] = hn::Mul(c.scattering[j], splat(grid_.sigma_s_most));
      const VF extinction = hn::Add(absorption[j], scattering[j]);
      most = hn::Max(most, extinction);
      queue_.set(ray_extinction + j, extinction);
      queue_.set(ray_lambda + j, lambda_nm[j]);
      queue_.set(ray_passes + j, one);
      queue_.set(ray_radiance + j, zero);
      if (world_.shares_paths) queue_.set(ray_share + j, gather(rays_.paths.share[j], row));
      glow[j] = splat(world_.volumes.emission_scale[volume_]);
    }
    by_channel(grid_.sigma_a, lambda_nm, absorption, ray_absorption);
    by_channel(grid_.sigma_s, lambda_nm, scattering, ray_scattering);
    if (grid_.glows) {
      if (!grid_.temperature.is_used()) {
        VF emission[4];
        eval_spectrum4(world_.spectra.view(), splat_u(world_.volumes.emission[volume_]), lambda_nm, emission);
        for (size_t j = 0; j < 4; ++j) glow[j] = hn::Mul(glow[j], emission[j]);
      }
      by_channel(grid_.emission, lambda_nm, glow, ray_emission);
    }
    return samples_leads_ ? queue_.get(ray_extinction) : most;
  }

  void by_channel(const GridUse& use, const VF lambda_nm[4], const VF value[4], size_t field) {
    if (use.channels != 3) {
      for (size_t j = 0; j < 4; ++j) queue_.set(field + j, value[j]);
      return;
    }
    for (size_t channel = 0; channel < 3; ++channel) {
      VF tint[4];
      eval_spectrum4(world_.spectra.view(), splat_u(use.tints[channel]), lambda_nm, tint);
      for (size_t j = 0; j < 4; ++j) queue_.set(field + 4 * channel + j, hn::Mul(value[j], tint[j]));
    }
  }

  const World& world_;
  const GridVolume& grid_;
  uint32_t volume_;
  const VolumeRays& rays_;
  const uint32_t* order_;
  uint32_t count_, next_ = 0, ready_ = 0;
  bool samples_leads_;  // delta tracking: the first wavelength's extinction decides
  RayLanes queue_;
};

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
