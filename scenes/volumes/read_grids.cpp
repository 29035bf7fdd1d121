#include "scenes/volumes/read_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/matrix.hpp>
#include <new>

#include "engine/schedule/workers.h"
#include "scenes/append_diagnostics.h"
#include "scenes/file_bytes.h"
#include "scenes/volumes/bricks.h"

namespace metamer {
namespace {

struct Job {
  GridRequest& request;
  Diagnostics diagnostics;
};

void read_by_kind(GridRequest& request) {
  char start[8] = {};
  std::ifstream(request.path, std::ios::binary).read(start, sizeof(start));
  if (std::memcmp(start, " BDV\0\0\0\0", 8) == 0) return read_vdb(request.path, request);
  if (std::memcmp(start, "NanoVDB", 7) == 0) return read_nvdb(request.path, request);
  throw GridError("expected an OpenVDB or a NanoVDB file");
}

// Numbers in a file may be anything.
void check_transform(const glm::dmat4& m) {
  const double volume = std::abs(glm::determinant(m));
  if (!(volume > 0) || !std::isfinite(volume))
    throw GridError(fmt::format("the determinant of its transform is {}; expected one that can be inverted", volume));
}

void read_one(Job& job) {
  GridRequest& request = job.request;
  if (!check_readable(request.path, request.named_at, job.diagnostics)) return;
  const auto error = [&](std::string_view what) {
    const std::string grid = request.found ? fmt::format(", grid '{}'", request.grid_name) : "";
    job.diagnostics.error(request.named_at, fmt::format("'{}'{}: {}", request.path, grid, what));
  };
  // Libraries throw, and what is thrown must not leave a worker thread.
  try {
    read_by_kind(request);
    if (!request.found) return;
    settle_transform(request.grid.index_to_local);
    check_transform(request.grid.index_to_local);
    check_values(request.grid, request.may_be_negative);
  } catch (const GridError& e) {
    error(e.what());
  } catch (const std::bad_alloc&) {
    error("it does not fit in the memory, or is damaged");
  } catch (const std::ios_base::failure&) {
    error("the file is cut short or damaged");
  } catch (const std::exception& e) {
    error(fmt::format("OpenVDB cannot read it: {}", e.what()));
  }
}

// A file that cannot be read is one mistake, however many of its grids a medium asks for.
bool is_told(const Diagnostics& all, const Diagnostics& some) {
  if (all.all().empty() || some.all().size() != 1) return false;
  const Diagnostic &last = all.all().back(), &next = some.all().front();
  return last.file == next.file && last.line == next.line && last.message == next.message;
}

}  // namespace

std::optional<size_t> choose_grid(const GridRequest& request, std::span<const std::string> names) {
  const std::string list = names.empty() ? "none" : fmt::format("'{}'", fmt::join(names, "', '"));
  if (request.grid_name.empty()) {
    if (names.size() == 1) return 0;
    throw GridError(fmt::format("the file has {} grids; expected the name of one of them: {}", names.size(), list));
  }
  const auto found = std::find(names.begin(), names.end(), request.grid_name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  if (request.may_be_missing) return std::nullopt;
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw GridError(fmt::format("there is no grid '{}'{} in it; there are: {}", request.grid_name,
                              did_you_mean(request.grid_name, known), list));
}

void refuse_level_set(const GridRequest& request) {
  if (!request.may_be_negative)
    throw GridError("it is a level set, a distance to a surface; expected a density or another amount");
}

void read_grids(std::span<GridRequest> requests, Diagnostics& diagnostics) {
  std::vector<Job> jobs;
  for (GridRequest& request : requests) jobs.push_back({request, {}});
  const auto read = [](void* context, uint32_t, size_t unit) {
    read_one((*static_cast<std::vector<Job>*>(context))[unit]);
  };
  run_units(available_threads(), jobs.size(), Cancellation(), read, &jobs);
  for (Job& job : jobs) {
    if (job.diagnostics.error_count() > 0) {
      job.request.found = false;
      job.request.grid = {};
    }
    if (!is_told(diagnostics, job.diagnostics)) append_diagnostics(diagnostics, job.diagnostics);
  }
}

}  // namespace metamer
