#include "scenes/late_mistakes.h"

#include <map>
#include <set>

#include "systems/freeze.h"

namespace metamer {
namespace {

using Lines = std::map<std::string, std::set<uint32_t>>;  // by file

Lines lines_of_entities(const Scene& scene) {
  Lines lines;
  scene.registry.each<Source>([&](Entity entity, uint32_t) {
    const SourceLocation at = scene.location(entity);
    lines[at.file].insert(at.line);
  });
  return lines;
}

// From the line of an entity up to that of the next one, is there one with a mistake?
bool has_mistake(const Lines& mistakes, const Lines& entities, const SourceLocation& at) {
  const auto in_file = mistakes.find(at.file), starts = entities.find(at.file);
  if (in_file == mistakes.end()) return false;
  const auto mistake = in_file->second.lower_bound(at.line);
  if (mistake == in_file->second.end()) return false;
  if (starts == entities.end()) return *mistake == at.line;
  const auto next = starts->second.upper_bound(at.line);
  return next == starts->second.end() || *mistake < *next;
}

}  // namespace

void add_late_mistakes(const Scene& scene, Diagnostics& diagnostics) {
  Diagnostics found;
  check(scene, found);
  Lines mistakes;
  for (const Diagnostic& d : diagnostics.all())
    if (d.severity == Severity::error) mistakes[d.file].insert(d.line);
  const Lines entities = lines_of_entities(scene);
  for (const Diagnostic& d : found.all()) {
    const SourceLocation at{d.file, d.line};
    if (d.severity == Severity::error && d.line > 0 && !has_mistake(mistakes, entities, at))
      diagnostics.error(at, d.message);
  }
}

}  // namespace metamer
