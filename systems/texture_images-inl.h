// Lookups of images: which level of it, which texels of that.
#if defined(METAMER_SYSTEMS_TEXTURE_IMAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TEXTURE_IMAGES_INL_H_
#undef METAMER_SYSTEMS_TEXTURE_IMAGES_INL_H_
#else
#define METAMER_SYSTEMS_TEXTURE_IMAGES_INL_H_
#endif

#include "engine/spectrum/spectrum-inl.h"
#include "systems/dimensions.h"
#include "systems/footprint-inl.h"
#include "systems/image_cache.h"
#include "systems/lanes-inl.h"
#include "systems/texture_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE VF between(VF a, VF b, VF share) { return hn::MulAdd(share, hn::Sub(b, a), a); }

// The level of an image that each lane looks up.
struct ImageLevel {
  VF width, height;
  VI columns, first_texel;
  VU file;  // in the cache, where the image is
  bool is_in_file;
};
// `files`: those of the rows of images, of which `image` is number `row`; its level 0, or one for each lane.
HWY_INLINE ImageLevel level_of(const TextureImage& image, const std::vector<uint32_t>& files, uint32_t row) {
  const auto count = [](uint32_t n) { return hn::Set(IntTag(), static_cast<int32_t>(n)); };
  const uint32_t file = row < files.size() ? files[row] : no_index;
  return {splat(static_cast<float>(image.width)),
          splat(static_cast<float>(image.height)),
          count(image.width),
          count(image.first_texel),
          splat_u(file),
          file != no_index};
}
HWY_INLINE ImageLevel level_of(const TextureImage& image, const std::vector<uint32_t>& files, uint32_t row, VI level) {
  const VI at = hn::ShiftLeft<2>(level);
  const auto count = [&](const uint32_t& first) { return as_index(gather(&first, at)); };
  const VI columns = count(image.width);
  const bool is_in_file = row < files.size() && files[row] != no_index;
  return {hn::ConvertTo(FloatTag(), columns),
          hn::ConvertTo(FloatTag(), count(image.height)),
          columns,
          count(image.first_texel),
          is_in_file ? gather(files.data() + row, level) : splat_u(no_index),
          is_in_file};
}

// A texel's column and row, and whether there is one.
struct TexelIndex {
  VI column, row;
  MF inside;
};
HWY_INLINE VI within(VF position, VF size) {
  const VF bounded = hn::Min(hn::Max(position, hn::Zero(FloatTag())), hn::Sub(size, splat(1.0f)));
  return hn::ConvertTo(IntTag(), bounded);
}
HWY_INLINE TexelIndex wrapped(VF x, VF y, const ImageLevel& level, TextureWrap wrap) {
  const VF zero = hn::Zero(FloatTag());
  const auto is_out = [&](VF position, VF size) { return hn::Or(hn::Lt(position, zero), hn::Le(size, position)); };
  const auto repeated = [](VF position, VF size) {
    return hn::NegMulAdd(hn::Floor(hn::Div(position, size)), size, position);
  };
  const MF out_x = is_out(x, level.width), out_y = is_out(y, level.height);
  MF inside = hn::Eq(zero, zero);
  switch (wrap) {
    case TextureWrap::repeat:
      x = repeated(x, level.width);
      y = repeated(y, level.height);
      break;
    case TextureWrap::octahedral: {
      // Over an edge: to its other half, the texels next to it touching each other.
      const VF last = hn::Sub(level.width, splat(1.0f)), last_row = hn::Sub(level.height, splat(1.0f));
      const auto turned = [&](VF position, VF end) {
        return hn::IfThenElse(hn::Lt(position, zero), hn::Sub(splat(-1.0f), position),
                              hn::Sub(hn::MulAdd(end, splat(2.0f), splat(1.0f)), position));
      };
      const VF folded_x = hn::IfThenElse(out_x, turned(x, last), x),
               folded_y = hn::IfThenElse(out_y, turned(y, last_row), y);
      x = hn::IfThenElse(out_y, hn::Sub(last, folded_x), folded_x);
      y = hn::IfThenElse(out_x, hn::Sub(last_row, folded_y), folded_y);
      break;
    }
    case TextureWrap::black: inside = hn::Not(hn::Or(out_x, out_y)); break;
    case TextureWrap::clamp: break;
  }
  return {within(x, level.width), within(y, level.height), inside};
}

HWY_INLINE VI texel_of(const ImageLevel& level, const TexelIndex& texel) {
  return hn::Add(level.first_texel, hn::Add(hn::Mul(texel.row, level.columns), texel.column));
}

// The numbers of a texel that is in a file.
template <int channels>
HWY_INLINE void fetch(const TextureSet& set, const ImageLevel& level, const TexelIndex& texel, VF out[channels]) {
  constexpr size_t most = hn::MaxLanes(FloatTag());
  static_assert(most <= most_cached_lanes);
  HWY_ALIGN uint32_t files[most];
  HWY_ALIGN int32_t columns[most], rows[most];
  HWY_ALIGN float numbers[channels * most];
  hn::Store(level.file, UintTag(), files);
  hn::Store(texel.column, IntTag(), columns);
  hn::Store(texel.row, IntTag(), rows);
  fetch_texels(*set.cache, files, columns, rows, static_cast<uint32_t>(lane_count()), channels, numbers);
  for (size_t c = 0; c < channels; ++c) out[c] = hn::LoadU(FloatTag(), numbers + c * lane_count());
}

HWY_INLINE void look_up(const TextureSet& set, const ImageLevel& level, const TexelIndex& texel,
                        const TexturePoint& point, VF out[4]) {
  VF c[4];
  if (level.is_in_file) {
    fetch<4>(set, level, texel, c);
  } else {
    const VI at = hn::ShiftLeft<2>(texel_of(level, texel));
    const float* texels = set.texels.data();
    for (int k = 0; k < 4; ++k) c[k] = gather(texels + k, at);
  }
  if (set.has_coefficients) {
    for (int j = 0; j < 4; ++j) {
      const VI channel = channel_of(point.lambda_nm[j]);
      const auto is = [&](int32_t n) { return hn::RebindMask(FloatTag(), hn::Eq(channel, hn::Set(IntTag(), n))); };
      out[j] = hn::IfThenElse(is(0), c[0], hn::IfThenElse(is(1), c[1], c[2]));
    }
  } else {
    for (int j = 0; j < 4; ++j) out[j] = hn::Mul(c[3], sigmoid_polynomial(c[0], c[1], c[2], point.lambda_nm[j]));
  }
}

// What a lookup stands for, in texels of level 0 along the image's sides: the steps of the two diameters.
struct TexelSteps {
  VF x[2], y[2];
};
HWY_INLINE TexelSteps texel_steps(const World& world, const TextureOp& op, const TextureImage& image,
                                  const TexturePoint& point) {
  const VF width = splat(static_cast<float>(image.width)), height = splat(static_cast<float>(image.height));
  TexelSteps steps;
  if (op.mapping.kind == TextureMapping::Kind::uv) {
    const VF x_scale = hn::Mul(splat(op.mapping.u_scale), width), y_scale = hn::Mul(splat(op.mapping.v_scale), height);
    for (int k = 0; k < 2; ++k) {
      steps.x[k] = hn::Mul(point.footprint[2 * k], x_scale);
      steps.y[k] = hn::Mul(point.footprint[2 * k + 1], y_scale);
    }
    return steps;
  }
  const Footprint on_surface = footprint(world.camera, point.position, point.normal);
  const Vec3 here = map_point(op.mapping, point);
  TexturePoint moved = point;
  for (int k = 0; k < 2; ++k) {
    moved.position = point.position + (k == 0 ? on_surface.shortest : on_surface.longest);
    Vec3 step = map_point(op.mapping, moved) - here;
    // A turn around the axis begins where it ends.
    VF& around = op.mapping.kind == TextureMapping::Kind::spherical ? step.y : step.x;
    if (op.mapping.kind == TextureMapping::Kind::spherical || op.mapping.kind == TextureMapping::Kind::cylindrical)
      around = hn::Sub(around, hn::Round(around));
    steps.x[k] = hn::Mul(step.x, width);
    steps.y[k] = hn::Mul(step.y, height);
  }
  return steps;
}

// The level, between 0 and the last one, whose texels are as wide as the longest diameter of the ellipse that the two
// steps span; or the shortest one, but at most op.most_anisotropy times less. Diameters are the singular values of the
// matrix of the steps.
HWY_INLINE VF chosen_level(const World& world, const TextureOp& op, const TextureImage& image,
                           const TexturePoint& point) {
  const VF zero = hn::Zero(FloatTag()), half = splat(0.5f);
  const TexelSteps s = texel_steps(world, op, image, point);
  const auto square = [](VF x, VF y) { return hn::MulAdd(x, x, hn::Mul(y, y)); };
  const VF squares = hn::Add(square(s.x[0], s.y[0]), square(s.x[1], s.y[1]));
  const VF area = hn::MulSub(s.x[0], s.y[1], hn::Mul(s.x[1], s.y[0]));
  const VF root = safe_sqrt(hn::MulSub(squares, squares, hn::Mul(splat(4.0f), hn::Mul(area, area))));
  VF diameter2 = hn::Mul(half, hn::Add(squares, root));
  if (op.filter == TextureFilter::anisotropic) {
    const VF shortest2 = hn::Mul(hn::Mul(area, area), safe_reciprocal(diameter2));
    diameter2 = hn::Max(shortest2, hn::Mul(diameter2, splat(1 / (op.most_anisotropy * op.most_anisotropy))));
  }
  constexpr float half_log2_e = 0.72134752f;
  const VF level = hn::Mul(log(diameter2), splat(half_log2_e));
  // What is not a number is level 0.
  return hn::IfThenElseZero(hn::Gt(level, zero), hn::Min(level, splat(static_cast<float>(image.levels - 1))));
}

// One texel of the four around the point, chosen in proportion to its share of the linear interpolation, and before it
// one of the two levels: right on average, on each wavelength, at an eighth of the price.
HWY_INLINE void image_spectrum(const World& world, const TextureOp& op, const TexturePoint& point, uint32_t nth,
                               VF out[4]) {
  const TextureSet& set = world.textures;
  const TextureImage& image = set.images[op.image];
  ImageLevel level = level_of(image, set.image_files, op.image);
  if (uses_levels(op.filter)) {
    const VF number = sample_1d(point.key, splat_u(texture_level_dimension(point.depth, nth)));
    const VF last = splat(static_cast<float>(image.levels - 1));
    const VF drawn = hn::Min(hn::Floor(hn::Add(chosen_level(world, op, image, point), number)), last);
    level = level_of(image, set.image_files, op.image, hn::ConvertTo(IntTag(), drawn));
  }
  const Vec3 at = map_point(op.mapping, point);
  VF x = hn::Mul(at.x, level.width);
  VF y = hn::Mul(hn::Sub(splat(1.0f), at.y), level.height);
  if (op.filter != TextureFilter::nearest) {
    VF jitter_x, jitter_y;
    sample_2d(point.key, splat_u(texture_image_dimension(point.depth, nth)), &jitter_x, &jitter_y);
    x = hn::Add(x, hn::Sub(jitter_x, splat(0.5f)));
    y = hn::Add(y, hn::Sub(jitter_y, splat(0.5f)));
  }
  const TexelIndex texel = wrapped(hn::Floor(x), hn::Floor(y), level, op.wrap);
  look_up(set, level, texel, point, out);
  const VF factor = hn::IfThenElseZero(texel.inside, splat(op.scale));
  for (int j = 0; j < 4; ++j) {
    const VF value = hn::Mul(factor, out[j]);
    out[j] = op.invert != 0 ? hn::Max(hn::Sub(splat(1.0f), value), hn::Zero(FloatTag())) : value;
  }
}

// The four texels around a place in pixels, and the shares of the right and the lower ones.
struct TexelSquare {
  TexelIndex texel[4];  // upper left, upper right, lower left, lower right
  VF right, lower;
};
HWY_INLINE TexelSquare texel_square(const ImageLevel& level, const Vec3& at, TextureWrap wrap) {
  const VF half = splat(0.5f);
  const VF x = hn::MulSub(at.x, level.width, half);
  const VF y = hn::MulSub(hn::Sub(splat(1.0f), at.y), level.height, half);
  const VF left = hn::Floor(x), top = hn::Floor(y);
  TexelSquare square;
  for (int k = 0; k < 4; ++k) {
    const VF step_x = splat(static_cast<float>(k & 1)), step_y = splat(static_cast<float>(k >> 1));
    square.texel[k] = wrapped(hn::Add(left, step_x), hn::Add(top, step_y), level, wrap);
  }
  square.right = hn::Sub(x, left);
  square.lower = hn::Sub(y, top);
  return square;
}

// Linear between texels; `slopes`, unless it is null, becomes the derivatives of this function by u and v of the image.
HWY_INLINE VF level_number(const TextureSet& set, const TextureOp& op, const ImageLevel& level, const Vec3& at,
                           VF* slopes) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  TexelSquare square = texel_square(level, at, op.wrap);
  if (op.filter == TextureFilter::nearest) {
    square.right = hn::IfThenElseZero(hn::Ge(square.right, splat(0.5f)), one);
    square.lower = hn::IfThenElseZero(hn::Ge(square.lower, splat(0.5f)), one);
  }
  VF texel[4];
  for (int k = 0; k < 4; ++k) {
    if (level.is_in_file)
      fetch<1>(set, level, square.texel[k], texel + k);
    else
      texel[k] = gather(set.numbers.data(), texel_of(level, square.texel[k]));
    texel[k] = hn::IfThenElseZero(square.texel[k].inside, texel[k]);
  }
  const VF upper = between(texel[0], texel[1], square.right), lower = between(texel[2], texel[3], square.right);
  if (slopes != nullptr) {
    const bool steps = op.filter == TextureFilter::nearest;
    const VF along_x = between(hn::Sub(texel[1], texel[0]), hn::Sub(texel[3], texel[2]), square.lower);
    slopes[0] = steps ? zero : hn::Mul(level.width, along_x);
    slopes[1] = steps ? zero : hn::Mul(level.height, hn::Sub(upper, lower));
  }
  return between(upper, lower, square.lower);
}

// Linear between levels, too: what follows from a number need not be linear in it, so nothing is drawn.
HWY_INLINE VF image_number(const World& world, const TextureOp& op, const TexturePoint& point, VF* slopes) {
  const TextureSet& set = world.textures;
  const TextureImage& image = set.images[op.image];
  const Vec3 at = map_point(op.mapping, point);
  VF number;
  if (uses_levels(op.filter)) {
    const VF level = chosen_level(world, op, image, point), last = splat(static_cast<float>(image.levels - 1));
    const VF lower = hn::Floor(level), share = hn::Sub(level, lower);
    const VF upper = hn::Min(hn::Add(lower, splat(1.0f)), last);
    VF more[2];
    const auto of = [&](VF nth, VF* its_slopes) {
      const ImageLevel its_level = level_of(image, set.image_files, op.image, hn::ConvertTo(IntTag(), nth));
      return level_number(set, op, its_level, at, its_slopes);
    };
    const VF fine = of(lower, slopes), coarse = of(upper, slopes != nullptr ? more : nullptr);
    number = between(fine, coarse, share);
    for (int k = 0; slopes != nullptr && k < 2; ++k) slopes[k] = between(slopes[k], more[k], share);
  } else {
    number = level_number(set, op, level_of(image, set.image_files, op.image), at, slopes);
  }
  const VF value = hn::Mul(splat(op.scale), number);
  if (slopes != nullptr) {
    const MF flat = hn::Ge(value, splat(op.invert != 0 ? 1.0f : FLT_MAX));
    const VF scale = splat(op.invert != 0 ? -op.scale : op.scale);
    for (int k = 0; k < 2; ++k) slopes[k] = hn::IfThenZeroElse(flat, hn::Mul(scale, slopes[k]));
  }
  return op.invert != 0 ? hn::Max(hn::Sub(splat(1.0f), value), hn::Zero(FloatTag())) : value;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
