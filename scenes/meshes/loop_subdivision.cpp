#include "scenes/meshes/loop_subdivision.h"

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <glm/geometric.hpp>
#include <memory>

namespace metamer {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

// What OpenSubdiv interpolates.
struct Point {
  glm::dvec3 p{0};
  void Clear() { p = glm::dvec3(0); }
  void AddWithWeight(const Point& other, double weight) { p += weight * other.p; }
};

// The triangles' vertices numbered by first use: those that no triangle has would stay where they are.
struct UsedVertices {
  std::vector<int> corners;
  std::vector<Point> points;
  explicit UsedVertices(const Mesh& control) {
    std::vector<int> number(control.positions.size(), -1);
    for (const uint32_t index : control.indices) {
      if (number[index] < 0) {
        number[index] = static_cast<int>(points.size());
        points.push_back({glm::dvec3(control.positions[index])});
      }
      corners.push_back(number[index]);
    }
  }
};

using Refiner = std::unique_ptr<Far::TopologyRefiner>;

Refiner refine(const UsedVertices& used, uint32_t levels) {
  const std::vector<int> sides(used.corners.size() / 3, 3);
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(used.points.size());
  descriptor.numFaces = static_cast<int>(sides.size());
  descriptor.numVertsPerFace = sides.data();
  descriptor.vertIndicesPerFace = used.corners.data();
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  Refiner refiner(Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_LOOP, options)));
  if (!refiner) return refiner;
  Far::TopologyRefiner::UniformOptions uniform(static_cast<int>(levels));
  uniform.fullTopologyInLastLevel = true;  // limits look at their neighbours
  refiner->RefineUniform(uniform);
  return refiner;
}

void push_limit(const Far::TopologyRefiner& refiner, std::vector<Point> points, Mesh& mesh) {
  const Far::PrimvarRefinerReal<double> interpolation(refiner);
  for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
    std::vector<Point> finer(static_cast<size_t>(refiner.GetLevel(level).GetNumVertices()));
    interpolation.Interpolate(level, points, finer);
    points = std::move(finer);
  }
  std::vector<Point> limit(points.size()), along(points.size()), across(points.size());
  interpolation.Limit(points, limit, along, across);
  for (size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 normal = glm::cross(along[i].p, across[i].p);
    const double length = glm::length(normal);
    mesh.positions.push_back(glm::vec3(limit[i].p));
    mesh.normals.push_back(length > 0 ? glm::vec3(normal / length) : glm::vec3(0));
  }
}

}  // namespace

bool subdivide_loop(const Mesh& control, uint32_t levels, const SourceLocation& at, Mesh& mesh,
                    Diagnostics& diagnostics) {
  const uint64_t triangles = control.indices.size() / 3;
  if (levels > 15 || triangles << (2 * levels) > most_subdivided_triangles) {
    diagnostics.error(at, fmt::format("{} triangles divided into four {} times are more than {}", triangles, levels,
                                      most_subdivided_triangles));
    return false;
  }
  for (size_t t = 0; t < control.indices.size(); t += 3) {
    const uint32_t a = control.indices[t], b = control.indices[t + 1], c = control.indices[t + 2];
    if (a != b && b != c && c != a) continue;
    diagnostics.error(at, fmt::format("triangle {} of the control mesh names a vertex twice", t / 3));
    return false;
  }
  mesh.positions.clear();
  mesh.normals.clear();
  mesh.indices.clear();
  if (triangles == 0) return true;
  const UsedVertices used(control);
  const Refiner refiner = refine(used, levels);
  if (!refiner) {
    diagnostics.error(at, "the triangles of the control mesh do not make a surface");
    return false;
  }
  push_limit(*refiner, used.points, mesh);
  const Far::TopologyLevel finest = refiner->GetLevel(refiner->GetMaxLevel());
  for (int face = 0; face < finest.GetNumFaces(); ++face) {
    const Far::ConstIndexArray corners = finest.GetFaceVertices(face);
    for (int k = 0; k < 3; ++k) mesh.indices.push_back(static_cast<uint32_t>(corners[k]));
  }
  return true;
}

}  // namespace metamer
