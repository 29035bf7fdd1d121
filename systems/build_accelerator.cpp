#include <fmt/format.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "engine/schedule/workers.h"
#include "engine/simd/instruction_set.h"
#include "systems/accelerator.h"
#include "systems/build_curves.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

void destroy(Accelerator* accelerator) {
  if (accelerator == nullptr) return;
  for (RTCScene scene : accelerator->shared_meshes) rtcReleaseScene(scene);
  if (accelerator->root != nullptr) rtcReleaseScene(accelerator->root);
  if (accelerator->device != nullptr) rtcReleaseDevice(accelerator->device);
  delete accelerator;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr float half_turn = 3.14159265f;  // radians

ShapeKind kind_of(const World& world, uint32_t object) { return static_cast<ShapeKind>(world.objects.kind[object]); }

struct ObjectRay {
  double origin[3], direction[3];
};

// The matrix of a moving object at a time within [0, 1], inverted. The keys are those of placement-inl.h.
void moving_to_object(const World& world, uint32_t object, float time, double (&to_object)[12]) {
  const uint32_t segments = world.objects.key_count[object] - 1;
  const double scaled = double{time} * segments;
  const uint32_t segment = std::min(static_cast<uint32_t>(scaled), segments - 1);
  const MotionKey* key = &world.motion_keys[world.objects.first_key[object] + segment];
  glm::dmat4 m(1.0);
  const double t = scaled - segment;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      m[column][row] =
          (1 - t) * double{key[0].to_world[4 * row + column]} + t * double{key[1].to_world[4 * row + column]};
  const glm::dmat4 inverse = glm::inverse(m);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) to_object[4 * row + column] = inverse[column][row];
}

template <class Number>
ObjectRay to_object_space(const Number (&to_object)[12], const float (&origin)[3], const float (&direction)[3]) {
  ObjectRay ray;
  for (int i = 0; i < 3; ++i) {
    const Number* row = to_object + 4 * i;
    ray.origin[i] = double{row[0]} * origin[0] + double{row[1]} * origin[1] + double{row[2]} * origin[2] + row[3];
    ray.direction[i] = double{row[0]} * direction[0] + double{row[1]} * direction[1] + double{row[2]} * direction[2];
  }
  return ray;
}

// Whether the angle of (x, y) is at most phi_max.
bool is_in_sector(const Placement& placement, double x, double y) {
  // Above 0: counter-clockwise of the last ray, by less than half a turn.
  const double beyond = placement.cos_phi_max * y - placement.sin_phi_max * x;
  return placement.phi_max <= half_turn ? y >= 0 && beyond <= 0 : y >= 0 || beyond <= 0;
}

// Distances along the ray at which it meets a sphere (3 dimensions) or cylinder (2), nearest first, where they are of
// the part that there is; others are infinite. The quadratic's discriminant comes from the distance between the ray and
// the centre, which does not cancel for far-away spheres (Haines, Guenther, Akenine-Moeller, "Precision Improvements
// for Ray/Sphere Intersection", Ray Tracing Gems, 2019).
template <int dimensions>
void round_distances(const Placement& placement, const ObjectRay& ray, double (&t)[2]) {
  const double radius = placement.radius;
  const auto dot = [](const double(&a)[3], const double(&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + (dimensions == 3 ? a[2] * b[2] : 0.0);
  };
  const double a = dot(ray.direction, ray.direction), b = -dot(ray.origin, ray.direction);
  if (a == 0) return;  // along a cylinder's axis
  double nearest[3];
  for (int i = 0; i < 3; ++i) nearest[i] = ray.origin[i] + b / a * ray.direction[i];
  const double discriminant = radius * radius - dot(nearest, nearest);
  if (!(discriminant >= 0)) return;
  const double c = dot(ray.origin, ray.origin) - radius * radius;
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  const double first = q != 0 ? c / q : 0, second = q / a;
  t[0] = std::min(first, second);
  t[1] = std::max(first, second);
  for (double& distance : t) {
    const double x = ray.origin[0] + distance * ray.direction[0], y = ray.origin[1] + distance * ray.direction[1];
    const double z = ray.origin[2] + distance * ray.direction[2];
    if (z < placement.z_min || z > placement.z_max || !is_in_sector(placement, x, y)) distance = infinity;
  }
}

void disk_distances(const Placement& placement, const ObjectRay& ray, double (&t)[2]) {
  if (ray.direction[2] == 0) return;
  const double distance = (double{placement.z_min} - ray.origin[2]) / ray.direction[2];
  const double x = ray.origin[0] + distance * ray.direction[0], y = ray.origin[1] + distance * ray.direction[1];
  const double r2 = x * x + y * y;
  if (r2 <= double{placement.radius} * placement.radius &&
      r2 >= double{placement.inner_radius} * placement.inner_radius && is_in_sector(placement, x, y))
    t[0] = distance;
}

// The nearest hit in (near, far) that is there, or infinity.
template <class IsThere>
float quadric_distance(const World& world, uint32_t object, const ObjectRay& ray, float near, float far,
                       const IsThere& counts) {
  const Placement& placement = world.placements[world.objects.placement[object]];
  double t[2] = {infinity, infinity};
  switch (kind_of(world, object)) {
    case ShapeKind::sphere: round_distances<3>(placement, ray, t); break;
    case ShapeKind::cylinder: round_distances<2>(placement, ray, t); break;
    default: disk_distances(placement, ray, t);
  }
  for (uint32_t nth = 0; nth < 2; ++nth) {
    const auto distance = static_cast<float>(t[nth]);
    if (t[nth] > near && t[nth] < far && counts(distance, nth)) return distance;
  }
  return std::numeric_limits<float>::infinity();
}

float lane_distance(const World& world, uint32_t object, const RTCIntersectContext* context, RTCRayN* rays, unsigned n,
                    unsigned lane) {
  const float origin[3] = {RTCRayN_org_x(rays, n, lane), RTCRayN_org_y(rays, n, lane), RTCRayN_org_z(rays, n, lane)};
  const float direction[3] = {RTCRayN_dir_x(rays, n, lane), RTCRayN_dir_y(rays, n, lane), RTCRayN_dir_z(rays, n, lane)};
  ObjectRay ray;
  if (world.objects.key_count[object] == 0) {
    ray = to_object_space(world.placements[world.objects.placement[object]].to_object, origin, direction);
  } else {
    double to_object[12];
    moving_to_object(world, object, RTCRayN_time(rays, n, lane), to_object);
    ray = to_object_space(to_object, origin, direction);
  }
  const auto counts = [&](float distance, uint32_t nth) {
    if (!world.has_masks) return true;
    RayHit hit;
    hit.object = object;
    hit.distance = distance;
    return is_there(world, *reinterpret_cast<const RayContext*>(context), RTCRayN_id(rays, n, lane), hit, nth);
  };
  return quadric_distance(world, object, ray, RTCRayN_tnear(rays, n, lane), RTCRayN_tfar(rays, n, lane), counts);
}

void intersect_quadric(const RTCIntersectFunctionNArguments* args) {
  const World& world = *static_cast<const Accelerator::Quadric*>(args->geometryUserPtr)->world;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const float distance = lane_distance(world, args->geomID, args->context, rays, args->N, lane);
    if (std::isinf(distance)) continue;
    RTCRayN_tfar(rays, args->N, lane) = distance;
    RTCHitN_geomID(hits, args->N, lane) = args->geomID;
    RTCHitN_primID(hits, args->N, lane) = args->primID;
    RTCHitN_instID(hits, args->N, lane, 0) = args->context->instID[0];
  }
}

void occluded_quadric(const RTCOccludedFunctionNArguments* args) {
  const World& world = *static_cast<const Accelerator::Quadric*>(args->geometryUserPtr)->world;
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    if (!std::isinf(lane_distance(world, args->geomID, args->context, args->ray, args->N, lane)))
      RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
  }
}

// The box of an affinely placed quadric: along each axis the support of the image of the whole ball, or of the disk and
// of the distance that it covers as a cylinder.
void quadric_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& [world_pointer, object] = *static_cast<const Accelerator::Quadric*>(args->geometryUserPtr);
  const World& world = *world_pointer;
  const Placement& placement = world.placements[world.objects.placement[object]];
  const bool is_sphere = kind_of(world, object) == ShapeKind::sphere;
  const double middle = is_sphere ? 0 : (double{placement.z_min} + placement.z_max) / 2;
  const double half_height = is_sphere ? 0 : (double{placement.z_max} - placement.z_min) / 2;
  // Of a moving one at the time of a key: a box of matrices in between lies within the boxes' interpolation.
  const bool moves = world.objects.key_count[object] > 0;
  const float* to_world =
      moves ? world.motion_keys[world.objects.first_key[object] + args->timeStep].to_world : placement.to_world;
  float lower[3], upper[3];
  for (int i = 0; i < 3; ++i) {
    const float* row = to_world + 4 * i;
    const double z = is_sphere ? double{row[2]} * row[2] : 0.0;
    const double extent = double{placement.radius} * std::sqrt(double{row[0]} * row[0] + double{row[1]} * row[1] + z) +
                          std::abs(double{row[2]}) * half_height;
    const double centre = row[3] + double{row[2]} * middle;
    const double slack = 1e-6 * (extent + std::abs(centre));
    lower[i] = static_cast<float>(centre - extent - slack);
    upper[i] = static_cast<float>(centre + extent + slack);
  }
  *args->bounds_o = {lower[0], lower[1], lower[2], 0, upper[0], upper[1], upper[2], 0};
}

void check(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw std::runtime_error(fmt::format("Embree failed with error {}", static_cast<int>(error)));
}

void set_masks(const World& world, RTCGeometry geometry) {
  if (!world.has_masks) return;
  rtcSetGeometryUserData(geometry, const_cast<World*>(&world));
  rtcSetGeometryIntersectFilterFunction(geometry, filter_masked);
  rtcSetGeometryOccludedFilterFunction(geometry, filter_masked);
}

RTCGeometry triangle_geometry(const World& world, RTCDevice device, uint32_t object) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const size_t vertices = world.normals.size() / 3;
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, world.positions.data(), 0,
                             3 * sizeof(float), vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, world.triangle_vertices.data(),
                             size_t{3} * sizeof(uint32_t) * world.objects.first_triangle[object], 3 * sizeof(uint32_t),
                             world.objects.triangle_count[object]);
  set_masks(world, geometry);
  return geometry;
}

RTCGeometry curve_geometry(const World& world, RTCDevice device, uint32_t object) {
  const bool are_ribbons = kind_of(world, object) == ShapeKind::ribbons;
  RTCGeometry geometry = rtcNewGeometry(
      device, are_ribbons ? RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE : RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE);
  const size_t points = world.curve_points.size() / 4;
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, world.curve_points.data(), 0,
                             4 * sizeof(float), points);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, world.curve_segments.data(),
                             sizeof(uint32_t) * world.objects.first_triangle[object], sizeof(uint32_t),
                             world.objects.triangle_count[object]);
  if (are_ribbons) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, world.curve_normals.data(), 0,
                               3 * sizeof(float), points);
  } else {
    rtcSetGeometryTessellationRate(geometry, pieces_of_segment);
  }
  set_masks(world, geometry);
  return geometry;
}

RTCGeometry quadric_geometry(Accelerator& accelerator, const World& world, uint32_t object) {
  RTCDevice device = accelerator.device;
  accelerator.quadrics.push_back({&world, object});
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, &accelerator.quadrics.back());
  rtcSetGeometryBoundsFunction(geometry, quadric_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_quadric);
  rtcSetGeometryOccludedFunction(geometry, occluded_quadric);
  return geometry;
}

// Embree takes the same keys, evenly spaced in time, and interpolates their matrices linearly as well.
void set_motion(const World& world, uint32_t object, bool is_instance, RTCGeometry geometry) {
  const uint32_t count = world.objects.key_count[object];
  if (count == 0) return;
  rtcSetGeometryTimeStepCount(geometry, count);
  for (uint32_t step = 0; is_instance && step < count; ++step)
    rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                            world.motion_keys[world.objects.first_key[object] + step].to_world);
}

// Spatial splits make the best trees.
RTCScene new_scene(RTCDevice device) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  return scene;
}

// The builder is the same every time only on one thread. A device with `threads=1` would see to that too, but Embree
// then keeps all of oneTBB at one thread for as long as the device lives, the rendering as well.
void commit_on_one_thread(RTCScene scene) {
  const auto commit = [](void* context, uint32_t, size_t) { rtcCommitScene(static_cast<RTCScene>(context)); };
  run_units(1, 1, Cancellation(), commit, scene);
}

}  // namespace

void build_accelerator(World& world) {
  auto* accelerator = new Accelerator;
  world.accelerator = {accelerator, destroy};
  const std::string config = fmt::format("isa={}", embree_isa_name());
  accelerator->device = rtcNewDevice(config.c_str());
  RTCDevice device = accelerator->device;
  if (device == nullptr) throw std::runtime_error("Embree could not be started with " + config);
  accelerator->root = new_scene(device);
  std::unordered_map<uint32_t, RTCScene> shared[2];  // by first triangle; by first segment
  for (uint32_t object = 0; object < world.objects.size(); ++object) {
    const bool is_mesh = kind_of(world, object) == ShapeKind::mesh, are_curves = is_curves(kind_of(world, object));
    if ((is_mesh || are_curves) && world.objects.triangle_count[object] == 0) continue;  // its id stays free
    const auto make_geometry = are_curves ? curve_geometry : triangle_geometry;
    RTCGeometry geometry = nullptr;
    const uint32_t placement = world.objects.placement[object];
    if (!is_mesh && !are_curves) {
      geometry = quadric_geometry(*accelerator, world, object);
    } else if (placement == 0) {
      geometry = make_geometry(world, device, object);
    } else {
      RTCScene& mesh = shared[are_curves][world.objects.first_triangle[object]];
      if (mesh == nullptr) {
        mesh = new_scene(device);
        RTCGeometry content = make_geometry(world, device, object);
        rtcCommitGeometry(content);
        rtcAttachGeometryByID(mesh, content, 0);
        rtcReleaseGeometry(content);
        commit_on_one_thread(mesh);
        accelerator->shared_meshes.push_back(mesh);
      }
      geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, mesh);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, world.placements[placement].to_world);
    }
    set_motion(world, object, is_mesh || are_curves, geometry);
    rtcSetGeometryMask(geometry, world.objects.visibility[object]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(accelerator->root, geometry, object);
    rtcReleaseGeometry(geometry);
  }
  commit_on_one_thread(accelerator->root);
  check(device);
}

}  // namespace metamer
