// Every column that flows between the systems. A batch is up to `batch_capacity` paths of one tile; all of its
// columns together stay within a core's L2 cache. Nothing here outlives a batch, except the slots, which live
// until the batch is accumulated.
//
// Per path: PathStream 112 bytes, twice (this bounce's and the next one's rays); HitStream 32; ShadeStream 376;
// ShadowStream 80; Slots 60. Columns that a scene has no use for are not touched.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "engine/simd/column.h"

namespace metamer {

inline constexpr uint32_t batch_capacity = 2048;  // paths; a multiple of 16
inline constexpr uint32_t dead_lane = 0xffffffffu;
inline constexpr uint32_t scattered = 0xfffffffeu;  // HitStream::object: no surface, but a scattering before it

// What a hit's lanes are sorted by: each kind has its own kernel over all its lanes. The last three end a path.
enum class ShadeKind : uint32_t {
  diffuse,
  diffuse_transmission,
  rough,
  smooth_coated,
  rough_coated,
  layered,
  hair,
  rough_conductor,
  rough_dielectric,
  smooth_conductor,
  dielectric,
  thin_dielectric,
  phase,  // scattering in a volume, not at a surface
  absorber,
  interface,  // without optical effect; paths pass it before they are sorted
  miss
};
inline constexpr uint32_t shade_kind_count = static_cast<uint32_t>(ShadeKind::miss) + 1;
// Of objects of several materials: the kind is chosen at every hit, by `sort`.
inline constexpr uint32_t mixed_kind = shade_kind_count;
// Rough kinds are lit by light samples, smooth kinds only by what lies in the few directions they answer to. A smooth
// coat does both: its body is rough, its surface mirrors.
inline constexpr ShadeKind rough_kinds[] = {
    ShadeKind::diffuse,       ShadeKind::diffuse_transmission, ShadeKind::rough,
    ShadeKind::smooth_coated, ShadeKind::rough_coated,         ShadeKind::layered,
    ShadeKind::hair,          ShadeKind::rough_conductor,      ShadeKind::rough_dielectric,
    ShadeKind::phase};
inline constexpr ShadeKind smooth_kinds[] = {ShadeKind::smooth_conductor, ShadeKind::dielectric,
                                             ShadeKind::thin_dielectric};

// Lanes [begin, end) of a sorted stream; begin is a multiple of 16, lanes up to the next multiple are dead.
struct Group {
  uint32_t begin = 0, end = 0;
  uint32_t padded_end() const { return static_cast<uint32_t>(padded_to_lanes(end)); }
};
using Groups = std::array<Group, shade_kind_count>;

// One allocation for all columns of a worker. Consecutive columns start a cache line more than a power of two
// apart, so that the same row of many columns does not fall into one cache set.
class BatchArena {
 public:
  void reserve(size_t bytes) { memory_.resize(bytes); }
  template <class T>
  T* take(size_t rows) {
    T* column = reinterpret_cast<T*>(memory_.data() + used_);
    used_ += (rows * sizeof(T) + column_alignment - 1) / column_alignment * column_alignment + column_alignment;
    return column;
  }
  size_t bytes() const { return memory_.bytes(); }

 private:
  Column<std::byte> memory_;
  size_t used_ = 0;
};

template <class T, size_t N>
using Columns = std::array<T*, N>;

// Calls `visit` with every column of a list of columns and groups of columns.
template <class Visit, class T>
void visit_columns(const Visit& visit, T*& column) {
  visit(column);
}
template <class Visit, class T, size_t N>
void visit_columns(const Visit& visit, Columns<T, N>& columns) {
  for (T*& column : columns) visit(column);
}
template <class Visit, class First, class... Rest>
void visit_columns(const Visit& visit, First& first, Rest&... rest) {
  visit_columns(visit, first);
  visit_columns(visit, rest...);
}

// Rows a sorted stream may need: every group may end in a partly filled vector.
inline constexpr uint32_t sorted_capacity = batch_capacity + shade_kind_count * column_lanes;

// Rays to trace and what their paths carry. Writers: camera_rays, then roulette, probe_rays or pop_nodes. A column more
// needs a line in for_each_column and one in append_ray (systems/shade-inl.h).
struct PathStream {
  uint32_t size = 0;
  Columns<float, 3> origin;     // metres
  Columns<float, 3> direction;  // unit length
  Columns<float, 4> lambda_nm;  // hero first; in RGB mode they stand for the channels, see engine/spectrum/color_mode.h
  Columns<float, 4> throughput;  // product of f cos / pdf; times the wavelengths' share after dispersion
  float* pdf_direction;          // per solid angle, of `direction` at its origin; 0: not sampled, or by a delta lobe
  float* eta_scale;              // (n of the first medium / n here)^2 so far: roulette must not see radiance scaling
  uint32_t *pixel_seed, *index;  // the path's key into the low-discrepancy points
  uint32_t* slot;                // its row in Slots
  float* time;                   // 0 to 1 while the shutter is open; only where World::has_motion
  Columns<uint32_t, 2> media;    // what the ray starts inside of (see MediumColumns); only where World::has_interiors
  uint32_t* volume;              // row of World::volumes that the ray starts in; only where World::has_volumes
  // Only where World::shares_paths: how likely each wavelength, had it led, would have made the path go as it did, up
  // to a factor that makes their sum live_wavelengths(). Throughput is by multiple importance over the leads: f /
  // mean(pdf of each lead). A wavelength that cannot have led here any more has 0.
  Columns<float, 4> share;
};

template <class Visit>
void for_each_column(PathStream& s, const Visit& visit) {
  visit_columns(visit, s.origin, s.direction, s.lambda_nm, s.throughput, s.pdf_direction, s.eta_scale, s.pixel_seed,
                s.index, s.slot, s.time, s.media, s.volume, s.share);
}

// Rows [first, first + count) of one stream to the front of another.
void copy_columns(PathStream& from, uint32_t first, uint32_t count, PathStream& to);

// A column more of this and the streams below needs a place in for_each_column (streams.cpp). Writer: intersect;
// `volumes` for what happens on the way.
struct HitStream {
  uint32_t* object;     // row of World::objects; no_index: the ray left the scene
  uint32_t* primitive;  // triangle or segment within the object
  float* distance;      // metres; exact for quadrics, Embree's (to be computed again) for triangles
  float* u;             // along a curve's segment, 0 to 1; only of curves
  uint32_t* material;   // row in the table of the kind. Writer: sort
  float* passed;        // metres up to the last interface that the ray passed
  float* reach;         // metres that the ray goes at most
  float* depth_left;    // optical depth that the leading wavelength still goes before it is scattered
};

// Vertices sorted by kind, one lane each; a dead lane has slot == dead_lane and throughput 0.
struct ShadeStream {
  uint32_t size = 0;
  Groups groups;
  // Writer: surface.
  Columns<float, 3> wo;                       // unit, towards the viewer
  Columns<float, 3> position;                 // metres; of a ray that left a world with portals, where it came from
  Columns<float, 3> normal;                   // geometric, unit, on the side the shape calls its outside
  Columns<float, 3> shading_normal, tangent;  // unit; tangent only where the world asks for it
  Columns<float, 2> uv;                       // only where World::needs_uvs()
  // What a texture lookup stands for, in u and v: along the shortest diameter on the surface, and along the longest one
  // (systems/footprint-inl.h); only where World::has_mips.
  Columns<float, 4> footprint;
  Columns<float, 3> dp_du, dp_dv;  // of the position, as shading sees it; only where the world has bumps
  Columns<float, 3> dn_du, dn_dv;  // of the shading normal; the same
  float* distance;                 // metres from the previous vertex
  float* offset;                   // metres along the normal that a new ray must start away from the surface
  uint32_t* material;              // row in the table of the kind
  uint32_t* light;                 // row of World::lights that this primitive is, or no_index
  Columns<float, 4> lambda_nm, throughput;
  float *pdf_direction, *eta_scale;
  uint32_t *pixel_seed, *index, *slot;
  Columns<uint32_t, 2> media;  // of the ray that came, where `carries_media`; corrected by `media`
  bool carries_media = false;
  float* time;  // of the path, where `carries_time`
  bool carries_time = false;
  // Writer: textures, in lanes whose material has one.
  Columns<float, 4> reflectance, transmittance;
  Columns<float, 2> alpha;  // GGX widths along and across the tangent
  // Of layered materials: of the base; optical; mean cosine. `transmittance` is the layer's albedo there.
  Columns<float, 2> base_alpha;
  float *thickness, *asymmetry;
  uint32_t* volume;              // that the ray came through, where `carries_volumes`
  Columns<uint32_t, 2> volumes;  // on the inside and the outside of the surface, where `carries_volumes`
  bool carries_volumes = false;
  bool carries_keys = false;  // shadow rays take the keys of their paths along
  Columns<float, 4> share;    // where `carries_shares`; kernels of what light enters know when a wavelength is alone
  bool carries_shares = false;
  // Writer: light_sample. Lanes without a light sample have radiance 0.
  Columns<float, 3> light_direction;  // unit, from the vertex
  Columns<float, 4> light_radiance;   // already divided by the pdf
  float* light_distance;              // metres; infinity for lights at infinity
  float* light_pdf;                   // per solid angle; 0 for point and directional lights
  // Writer: the BSDF kernel of the kind.
  Columns<float, 3> next_direction;  // unit
  Columns<float, 4> next_weight;     // f cos / pdf
  float* next_pdf;                   // per solid angle; 0 for a delta lobe
  float* next_eta_scale;             // factor on eta_scale: 1 but at a refraction
  // Writers: `media` (as they were), then the kernels of what light enters.
  Columns<uint32_t, 2> next_media;
  uint32_t lost_media = 0;  // counted where a path is inside of more than media_stack_size
};

// Light samples that are not 0, to be tested for occlusion. Writer: the BSDF kernels.
struct ShadowStream {
  uint32_t size = 0;
  Columns<float, 3> origin, direction;
  float* t_far;
  Columns<float, 4> contribution;  // radiance at the camera if the light is seen
  uint32_t* slot;
  Columns<float, 4> lambda_nm;  // this and the volume that the ray starts in: only where the shading carries volumes
  uint32_t* volume;
  float* time;                   // where World::has_motion
  uint32_t *pixel_seed, *index;  // of the path, where World::has_grids
};

// What a path, or one node of a ray tree, gathers, by its place in the batch.
struct Slots {
  uint32_t size = 0;
  bool are_roots = true;  // camera samples; false: further nodes of trees whose roots are accounted for already
  Columns<float, 4> lambda_nm, inv_pdf_nm;
  Columns<float, 4> radiance;  // W m^-2 sr^-1 nm^-1, each wavelength on its own; in RGB mode a channel's, cd/m^2
  uint32_t *pixel, *sample;    // pixel of the tile (row-major), or dead_lane outside the picture; sample index
  float* weight;               // of the pixel filter: what of the radiance counts; below 0 in negative lobes
  float limit = std::numeric_limits<float>::infinity();  // of the mean radiance of what is being added; pipeline
};

// Rays that wait for their turn: nodes of ray trees (recursive). Those of one depth lie together, the deepest last, and
// the last are worked first, so that no more than a batch waits at each depth. Writers: push_nodes, pop_nodes.
inline constexpr float least_node_importance = 1e-6f;  // of a camera ray's 1; nodes that carry less are dropped
struct NodeStack {
  struct Level {
    uint32_t depth, begin;  // its nodes end where the next level begins
  };
  PathStream rays;  // `size` nodes; slot unused
  Columns<float, 4> inv_pdf_nm;
  uint32_t *pixel, *sample;
  float* weight;
  std::vector<Level> levels;
  uint32_t capacity = 0;
  Column<std::byte> memory;

  // Room for so many rows and a vector of padding; what is there is kept.
  void reserve(uint32_t rows);
};
template <class Visit>
void for_each_column(NodeStack& s, const Visit& visit) {
  for_each_column(s.rays, visit);
  visit_columns(visit, s.inv_pdf_nm, s.pixel, s.sample, s.weight);
}

struct Batch {
  Batch();
  size_t bytes() const { return arena.bytes() + nodes.memory.bytes() + (crossings ? crossings->bytes() : 0); }
  BatchArena arena;
  PathStream paths, next;
  HitStream hits;
  ShadeStream shade;
  ShadowStream shadow;
  Slots slots;
  NodeStack nodes;
  uint32_t* order;  // sorted lane -> path; dead_lane where padding
  // For shadow rays on their way through interfaces; made when there are any.
  std::unique_ptr<Batch> crossings;
};

}  // namespace metamer
