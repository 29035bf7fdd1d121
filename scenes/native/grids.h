// The grids of media: files are read together when all media are known.
#pragma once
#include <vector>

#include "scenes/native/scene_context.h"
#include "scenes/volumes/read_grids.h"

namespace metamer {

class MediumGrids {
 public:
  explicit MediumGrids(SceneContext& context) : context_(context) {}

  // Sets the MediumGrid of a medium of type "grid", as far as it does not depend on files.
  void add(Entity medium, const JsonObject& object);
  // Reads the files on all threads, each grid once, and completes the media.
  void read_files();

 private:
  struct Use {
    Entity medium;
    GridId MediumGrid::*handle;
  };
  struct Pending {
    GridRequest request;
    ColorSpace space;
    std::vector<Use> uses;
  };

  void read_grid(Entity medium, const JsonObject& object, std::string_view key, MediumGrid& grids,
                 GridId MediumGrid::*handle);
  void add_file(const JsonObject& object, Use use);
  GridId add_noise(const JsonObject& noise, std::string_view key);
  GridId add_grid(Grid&& grid);
  void complete_box(Entity medium);

  SceneContext& context_;
  std::vector<Pending> pending_;
  std::vector<Entity> boxless_;  // media whose grids say how large they are
};

}  // namespace metamer
