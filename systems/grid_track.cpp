// Delta and ratio tracking (E. Woodcock et al. 1965; J. Novak, A. Selle, W. Jarosz 2014) by majorants of cells, which
// rays walk through as J. Amanatides and A. Woo did ("A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/grid_track.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/grid_place-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Where rays have got to: `collided` ones in a cell with that majorant, and that much at least.
struct Walked {
  MF collided, left;
  VF majorant, least;
};

// Steps from cell to cell, until most lanes have collided or left the grids. `controls`: collisions are of what there
// is in a cell above its least, and ray_depth is the integral of the least.
template <bool controls>
HWY_INLINE Walked walk(const float* majorants, const int32_t cells[3], MF live, RayLanes& lanes, GridWork& work) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const VF nx = splat(static_cast<float>(cells[0])), ny = splat(static_cast<float>(cells[1]));
  const VF nz = splat(static_cast<float>(cells[2]));
  const Vec3 bias = lanes.get3(ray_bias), inverse = lanes.get3(ray_inverse);
  const Vec3 stride = {hn::CopySign(one, inverse.x), hn::CopySign(one, inverse.y), hn::CopySign(one, inverse.z)};
  const VF end = lanes.get(ray_end);
  VF at = lanes.get(ray_at), left = lanes.get(ray_left), depth = lanes.get(ray_depth);
  Vec3 cell = lanes.get3(ray_cell);
  Walked walked{hn::Ne(zero, zero), hn::Ne(zero, zero), zero, zero};
  MF walking = live;
  const size_t few = lane_count() / 4;
  do {
    work.steps += hn::CountTrue(d, walking);
    const VF place = hn::MulAdd(hn::MulAdd(cell.z, ny, cell.y), nx, cell.x);
    const VI pair = hn::ShiftLeft<1>(hn::ConvertTo(IntTag(), hn::IfThenElseZero(walking, place)));
    const VF least = controls ? gather(majorants + 1, pair) : zero;
    const VF majorant = hn::Sub(gather(majorants, pair), least);
    const Vec3 next = {hn::Mul(hn::Add(cell.x, bias.x), inverse.x), hn::Mul(hn::Add(cell.y, bias.y), inverse.y),
                       hn::Mul(hn::Add(cell.z, bias.z), inverse.z)};
    const VF exit = hn::Max(hn::Min(hn::Min(next.x, next.y), hn::Min(next.z, end)), at);
    const VF crossed = hn::Mul(majorant, hn::Sub(exit, at));
    const MF collides = hn::And(walking, hn::Gt(crossed, left));
    const MF moves = hn::AndNot(collides, walking);
    const VF until = hn::Div(left, hn::IfThenElse(collides, majorant, one));
    const VF before = at;
    at = hn::IfThenElse(collides, hn::Min(hn::Add(at, until), exit), hn::IfThenElse(moves, exit, at));
    if (controls)
      depth = hn::MulAdd(least, hn::Sub(at, before), depth);
    else
      depth = hn::Add(depth, hn::IfThenElse(collides, left, hn::IfThenElseZero(moves, crossed)));
    left = hn::Sub(left, hn::IfThenElseZero(moves, crossed));
    walked.majorant = hn::IfThenElse(collides, majorant, walked.majorant);
    if (controls) walked.least = hn::IfThenElse(collides, least, walked.least);
    walked.collided = hn::Or(walked.collided, collides);
    const auto step = [&](VF c, VF where, VF by) {
      return hn::IfThenElse(hn::And(moves, hn::Le(where, exit)), hn::Add(c, by), c);
    };
    cell = {step(cell.x, next.x, stride.x), step(cell.y, next.y, stride.y), step(cell.z, next.z, stride.z)};
    const MF below = hn::Lt(hn::Min(hn::Min(cell.x, cell.y), cell.z), zero);
    const MF above = hn::Or(hn::Ge(cell.x, nx), hn::Or(hn::Ge(cell.y, ny), hn::Ge(cell.z, nz)));
    const MF leaves = hn::And(moves, hn::Or(hn::Ge(exit, end), hn::Or(below, above)));
    walked.left = hn::Or(walked.left, leaves);
    walking = hn::AndNot(leaves, moves);
  } while (hn::CountTrue(d, walking) > few);
  lanes.set(ray_at, at);
  lanes.set(ray_left, left);
  lanes.set(ray_depth, depth);
  lanes.set3(ray_cell, cell);
  return walked;
}

// `leads`: delta tracking, else ratio tracking. `parts`: extinction differs between wavelengths. `controls`, of ratio
// tracking: what a cell holds at least is taken out exactly (Novak, Selle, Jarosz, "Residual Ratio Tracking for
// Estimating Attenuation in Participating Media", ACM TOG 33(6), 2014).
template <bool leads, bool parts, bool controls>
class Tracker {
 public:
  Tracker(const World& world, uint32_t volume, const VolumeRays& rays, const uint32_t* order, uint32_t count,
          GridWork& work)
      : world_(world),
        volume_(world.grid_volumes[world.volumes.grid[volume]]),
        rays_(rays),
        queue_(world, volume, rays, order, count),
        work_(work),
        live_share_(1 / static_cast<float>(live_wavelengths(world.settings))) {}

  void run() {
    const float* majorants = world_.majorants.data() + 2 * size_t{volume_.first_majorant};
    uint32_t live = queue_.refill((1u << lane_count()) - 1, lanes_);
    while (live != 0) {
      const Walked walked = walk<controls>(majorants, volume_.cells, mask_of(live), lanes_, work_);
      MF done = walked.left, is_scattered = hn::Ne(walked.majorant, walked.majorant);
      if (leads && parts && !hn::AllFalse(FloatTag(), walked.left)) leave(walked.left);
      if (!hn::AllFalse(FloatTag(), walked.collided)) done = hn::Or(done, collide(walked, &is_scattered));
      if (controls && !hn::AllFalse(FloatTag(), done)) take_control(done);
      const uint32_t arrived = bits_of(done), ended = bits_of(is_scattered);
      if (arrived == 0) continue;
      for (uint32_t left = arrived; left != 0; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        retire(lane, (ended >> lane & 1) != 0);
      }
      live = (live & ~arrived) | queue_.refill(arrived, lanes_);
    }
  }

 private:
  // One collision of each lane that has one. Returns those for which it is the last.
  MF collide(const Walked& walked, MF* is_scattered) {
    const FloatTag d;
    const VF one = splat(1.0f), zero = hn::Zero(d);
    const VF majorant = hn::IfThenElse(walked.collided, walked.majorant, one);
    const VU event = lanes_.get_u(ray_event);
    const CollisionNumbers numbers = collision_numbers(lanes_.get_u(ray_key), event);
    const VF u = unit_float(numbers.first);
    const Vec3 cells = mul_add(lanes_.get3(ray_direction), lanes_.get(ray_at), lanes_.get3(ray_origin));
    const Place place(world_, volume_, cells, numbers.second);
    work_.lookups += hn::CountTrue(d, walked.collided);
    MF ends =
        leads ? (parts ? delta_apart(walked.collided, majorant, place, u) : delta(walked.collided, majorant, place, u))
              : ratio(walked, majorant, place, u);
    if (leads) *is_scattered = ends;
    const MF too_many = hn::AndNot(ends, hn::And(walked.collided, float_mask(hn::Eq(event, splat_u(most_collisions)))));
    if (!hn::AllFalse(d, too_many)) {
      work_.unfinished += static_cast<uint32_t>(hn::CountTrue(d, too_many));
      for (size_t j = 0; j < 4; ++j)
        lanes_.set(ray_passes + j, hn::IfThenZeroElse(too_many, lanes_.get(ray_passes + j)));
      ends = hn::Or(ends, too_many);
    }
    const VF left = divide_or_infinity(exponential(numbers.second), lanes_.get(ray_lead));
    lanes_.set(ray_left, hn::IfThenElse(walked.collided, left, lanes_.get(ray_left)));
    if (!controls) lanes_.set(ray_depth, hn::IfThenElse(walked.collided, zero, lanes_.get(ray_depth)));
    lanes_.set_u(ray_event, hn::Add(event, hn::IfThenElseZero(uint_mask(walked.collided), splat_u(1))));
    return ends;
  }

  void gather_glow(MF mask, const Place& place, const VF weight[4]) {
    VF emission[4];
    place.emission(lanes_, emission);
    for (size_t j = 0; j < 4; ++j) {
      const VF before = lanes_.get(ray_radiance + j);
      lanes_.set(ray_radiance + j, hn::IfThenElse(mask, hn::MulAdd(weight[j], emission[j], before), before));
    }
  }

  // All wavelengths alike: a real collision has the share of what is there in the majorant; before it nothing changes.
  MF delta(MF mask, VF majorant, const Place& place, VF u) {
    const VF real = hn::Min(hn::Div(place.density(), majorant), splat(1.0f));
    const VF lead = lanes_.get(ray_lead);
    if (volume_.glows) {
      VF weight[4];
      for (size_t j = 0; j < 4; ++j) weight[j] = hn::Mul(real, hn::Div(lanes_.get(ray_absorption + j), lead));
      gather_glow(mask, place, weight);
    }
    const MF ends = hn::And(mask, hn::Lt(u, real));
    for (size_t j = 0; j < 4; ++j) {
      const VF albedo = hn::Div(lanes_.get(ray_scattering + j), lead);
      lanes_.set(ray_passes + j, hn::IfThenElse(ends, albedo, lanes_.get(ray_passes + j)));
    }
    return ends;
  }

  // Each wavelength by multiple importance over the leads, as sample_free_path() has it; p_j of a null collision is
  // exp(-majorant_j s) (majorant_j - sigma_t_j), of a real one exp(-majorant_j s) sigma_t_j.
  MF delta_apart(MF mask, VF majorant, const Place& place, VF u) {
    const Matter matter = place.matter(lanes_, majorant);
    VF passes[4], most[4];
    for (size_t j = 0; j < 4; ++j) {
      const VF extinction = lanes_.get(ray_extinction + j);
      passes[j] = exp(hn::Neg(hn::Mul(extinction, lanes_.get(ray_depth))));
      most[j] = hn::Mul(majorant, extinction);
    }
    if (volume_.glows) {
      VF p[4], weight[4];
      for (size_t j = 0; j < 4; ++j) p[j] = hn::Mul(passes[j], most[j]);
      const VF inverse = inverse_mean(p);
      for (size_t j = 0; j < 4; ++j)
        weight[j] = hn::Mul(hn::Mul(lanes_.get(ray_passes + j), passes[j]), hn::Mul(matter.absorption[j], inverse));
      gather_glow(mask, place, weight);
    }
    const MF ends = hn::And(mask, hn::Lt(hn::Mul(u, most[0]), matter.extinction[0]));
    VF f[4], p[4];
    for (size_t j = 0; j < 4; ++j) {
      const VF nothing = hn::Sub(most[j], matter.extinction[j]);
      f[j] = hn::Mul(passes[j], hn::IfThenElse(ends, matter.scattering[j], nothing));
      p[j] = hn::Mul(passes[j], hn::IfThenElse(ends, matter.extinction[j], nothing));
    }
    weigh(mask, f, p);
    return ends;
  }

  // Rays that get out of the grids, by the same weights.
  void leave(MF mask) {
    VF passes[4];
    for (size_t j = 0; j < 4; ++j)
      passes[j] = exp(hn::Neg(hn::Mul(lanes_.get(ray_extinction + j), lanes_.get(ray_depth))));
    weigh(mask, passes, passes);
  }

  // 1 / mean_i(share_i p_i); 0 where rounding leaves nothing.
  VF inverse_mean(const VF p[4]) const {
    VF sum = hn::Zero(FloatTag());
    for (size_t j = 0; j < 4; ++j) sum = hn::MulAdd(lanes_.get(ray_share + j), p[j], sum);
    const VF mean = hn::Mul(sum, splat(live_share_));
    return hn::IfThenElseZero(hn::Gt(mean, hn::Zero(FloatTag())), hn::Div(splat(1.0f), hn::Max(mean, splat(1e-37f))));
  }
  void weigh(MF mask, const VF f[4], const VF p[4]) {
    const VF inverse = inverse_mean(p);
    for (size_t j = 0; j < 4; ++j) {
      const VF passes = lanes_.get(ray_passes + j), share = lanes_.get(ray_share + j);
      lanes_.set(ray_passes + j, hn::IfThenElse(mask, hn::Mul(passes, hn::Mul(f[j], inverse)), passes));
      lanes_.set(ray_share + j, hn::IfThenElse(mask, hn::Mul(share, hn::Mul(p[j], inverse)), share));
    }
  }

  // What the leasts of the cells have let through so far.
  void control(VF out[4]) const {
    const VF depth = lanes_.get(ray_depth);
    for (size_t j = 0; j < 4; ++j)
      out[j] = j > 0 && !parts ? out[0] : exp(hn::Neg(hn::Mul(lanes_.get(ray_extinction + j), depth)));
  }
  void take_control(MF mask) {
    VF factor[4];
    control(factor);
    for (size_t j = 0; j < 4; ++j) {
      const VF passes = lanes_.get(ray_passes + j);
      lanes_.set(ray_passes + j, hn::IfThenElse(mask, hn::Mul(passes, factor[j]), passes));
    }
  }

  // Collisions are drawn for the wavelength that is extinguished most, so each lets every wavelength through by 0 to 1.
  // Rays of which less than a tenth is left on all wavelengths are ended by chance or brought back to a tenth.
  MF ratio(const Walked& walked, VF majorant, const Place& place, VF u) {
    const VF one = splat(1.0f);
    VF absorption[4], extinction[4], passes[4];
    const VF inverse = hn::Div(one, hn::Mul(majorant, lanes_.get(ray_lead)));
    const VF most = controls ? hn::Add(majorant, walked.least) : majorant;
    if (parts) {
      const Matter matter = place.matter(lanes_, most);
      for (size_t j = 0; j < 4; ++j) absorption[j] = matter.absorption[j], extinction[j] = matter.extinction[j];
    } else {
      const VF density = hn::Min(place.density(), most);
      for (size_t j = 0; j < 4; ++j) {
        absorption[j] = hn::Mul(density, lanes_.get(ray_absorption + j));
        extinction[j] = hn::Mul(density, lanes_.get(ray_extinction + j));
      }
    }
    for (size_t j = 0; j < 4; ++j) passes[j] = lanes_.get(ray_passes + j);
    if (!controls && volume_.glows && rays_.slots != nullptr) {
      VF weight[4];
      for (size_t j = 0; j < 4; ++j) weight[j] = hn::Mul(passes[j], hn::Mul(absorption[j], inverse));
      gather_glow(walked.collided, place, weight);
    }
    VF carried[4] = {one, one, one, one};
    if (controls) control(carried);
    for (size_t j = 0; j < 4; ++j) {
      if (controls) extinction[j] = hn::NegMulAdd(walked.least, lanes_.get(ray_extinction + j), extinction[j]);
      passes[j] = hn::Mul(passes[j], clamp(hn::NegMulAdd(extinction[j], inverse, one), 0.0f, 1.0f));
      carried[j] = hn::Mul(carried[j], passes[j]);
    }
    const VF survival = hn::Min(hn::Mul(max_of(carried), splat(10.0f)), one);
    const MF ends = hn::And(walked.collided, hn::Ge(u, survival));
    const VF gain = hn::IfThenElseZero(hn::Gt(survival, u), hn::Div(one, hn::Max(survival, splat(1e-30f))));
    for (size_t j = 0; j < 4; ++j) {
      const VF before = lanes_.get(ray_passes + j);
      lanes_.set(ray_passes + j, hn::IfThenElse(walked.collided, hn::Mul(passes[j], gain), before));
    }
    return ends;
  }

  void retire(int lane, bool is_scattered) {
    const uint32_t row = lanes_.word(ray_row, lane);
    for (size_t j = 0; j < 4; ++j) {
      float& throughput = rays_.paths.throughput[j][row];
      if (volume_.glows && rays_.slots != nullptr)
        rays_.slots->radiance[j][rays_.paths.slot[row]] += throughput * lanes_.words[ray_radiance + j][lane];
      throughput *= lanes_.words[ray_passes + j][lane];
      if (leads && parts) rays_.paths.share[j][row] = lanes_.words[ray_share + j][lane];
    }
    if (!leads) return;
    if (is_scattered) {
      rays_.hits.distance[row] = lanes_.words[ray_start][lane] + lanes_.words[ray_at][lane];
      rays_.hits.object[row] = scattered;
    } else if (lanes_.words[ray_lead][lane] > 0) {
      rays_.hits.depth_left[row] = lanes_.words[ray_left][lane] * lanes_.words[ray_lead][lane];
    }
  }

  const World& world_;
  const GridVolume& volume_;
  const VolumeRays& rays_;
  RayQueue queue_;
  RayLanes lanes_;
  GridWork& work_;
  float live_share_;
};

void track_kernel(const World& world, uint32_t volume, const VolumeRays& rays, const uint32_t* order, uint32_t count,
                  GridWork& work) {
  const bool leads = rays.scatters && world.volumes.scatters[volume] != 0;
  const bool parts = !world.grid_volumes[world.volumes.grid[volume]].is_grey;
  const bool glows = world.grid_volumes[world.volumes.grid[volume]].glows && rays.slots != nullptr;
  const auto run = [&]<bool leading, bool parting, bool controlling>() {
    Tracker<leading, parting, controlling>(world, volume, rays, order, count, work).run();
  };
  if (leads)
    return parts ? run.template operator()<true, true, false>() : run.template operator()<true, false, false>();
  if (glows)
    return parts ? run.template operator()<false, true, false>() : run.template operator()<false, false, false>();
  parts ? run.template operator()<false, true, true>() : run.template operator()<false, false, true>();
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(track_kernel);

void track_grid(const World& world, uint32_t volume, const VolumeRays& rays, const uint32_t* order, uint32_t count,
                GridWork& work) {
  HWY_DYNAMIC_DISPATCH(track_kernel)(world, volume, rays, order, count, work);
}

}  // namespace metamer
#endif
