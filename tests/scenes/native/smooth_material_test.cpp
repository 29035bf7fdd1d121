// Materials that light enters, and the mirror: what correct ones become, and what wrong ones are told.
#include <gmock/gmock.h>

#include "scenes/native/read_native.h"
#include "scenes/read_scene.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {
using testing::HasSubstr;

struct NativeResult {
  bool ok = false;
  Scene scene;
  Diagnostics diagnostics;
  std::string messages() const { return format_diagnostics(diagnostics); }

  template <class C>
  C get(std::string_view name) const {
    Entity found;
    scene.registry.each<Name>([&](Entity entity, uint32_t row) {
      if (scene.names[scene.registry.table<Name>().get(row).name] == name) found = entity;
    });
    return scene.registry.get<C>(found);
  }
};

NativeResult read(const std::string& text) {
  NativeResult result;
  const TemporaryFile file("scene.json", text);
  result.ok = read_native(file.path(), result.scene, result.diagnostics);
  return result;
}

// The messages about one material, which stands on line 2, without the folder of the file.
std::string messages_of_material(const std::string& material) {
  NativeResult result = read("{\"metamer\": 1, \"materials\": {\n\"m\": " + material + "\n}, \"entities\": []}");
  EXPECT_FALSE(result.ok);
  std::string text = result.messages(), shown;
  for (size_t at; (at = text.find("scene.json:")) != std::string::npos;) {
    const size_t end = text.find('\n', at);
    shown += text.substr(at, end + 1 - at);
    text.erase(0, end + 1);
  }
  return shown;
}

TEST(SmoothMaterial, HasAnIndexAKappaAndAnInside) {
  const NativeResult r = read(
      "{\"metamer\": 1, \"units\": \"cm\", \"materials\": {"
      "\"tea\": {\"type\": \"smooth\", \"glass\": \"water\", \"kappa\": 1e-6, \"priority\": 4},"
      "\"foil\": {\"type\": \"smooth\", \"metal\": \"Au\", \"thin\": true, \"thickness\": 2},"
      "\"mirror\": {\"type\": \"mirror\"},"
      "\"frost\": {\"type\": \"dielectric\", \"eta\": 1.5, \"roughness\": [0.1, 0.3], \"kappa\": 1e-9}}, \"entities\": "
      "[]}");
  ASSERT_TRUE(r.ok) << r.messages();
  const Material tea = r.get<Material>("tea"), foil = r.get<Material>("foil"), frost = r.get<Material>("frost");
  EXPECT_EQ(tea.kind, MaterialKind::smooth);
  EXPECT_NEAR(r.scene.spectra.value(tea.eta, 589), 1.333, 1e-3);
  EXPECT_NEAR(r.scene.spectra.value(tea.kappa, 500), 1e-6, 1e-12);
  EXPECT_EQ(tea.priority, 4u);
  EXPECT_EQ(tea.thin, 0u);
  EXPECT_EQ(foil.thin, 1u);
  EXPECT_NEAR(foil.thickness, 0.02, 1e-8);
  EXPECT_GT(r.scene.spectra.value(foil.kappa, 600), 2);
  EXPECT_EQ(r.get<Material>("mirror").kind, MaterialKind::conductor);
  EXPECT_EQ(frost.kind, MaterialKind::dielectric);
  EXPECT_EQ(frost.alpha_x, 0.1f);
  EXPECT_EQ(frost.alpha_y, 0.3f);
  EXPECT_EQ(frost.priority, 0u);
}

TEST(SmoothMaterial, WrongOnesAreToldSoWithTheirName) {
  EXPECT_EQ(messages_of_material("{\"type\": \"smooth\", \"n\": 0, \"kappa\": -1, \"thickness\": 2, \"priority\": 0}"),
            "scene.json:2: error: 'n' is the number 0; expected a number above 0 (in material 'm')\n"
            "scene.json:2: error: 'kappa' is the number -1; expected a number of at least 0 (in material 'm')\n"
            "scene.json:2: error: 'priority' is the number 0; expected a whole number from 1 to 255 (in material 'm')\n"
            "scene.json:2: error: 'thickness' belongs to 'thin' only (in material 'm')\n");
  EXPECT_THAT(messages_of_material("{\"type\": \"smooth\", \"metal\": \"Au\", \"kappa\": 1}"),
              HasSubstr("'metal' and 'kappa' exclude each other"));
  EXPECT_THAT(messages_of_material("{\"type\": \"smooth\", \"glass\": \"BK7\", \"n\": 1}"),
              HasSubstr("'glass' and 'n' exclude each other"));
  EXPECT_THAT(messages_of_material("{\"type\": \"smooth\"}"), HasSubstr("expected 'metal', 'glass' or 'n'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1.5, \"kappa\": 0.5}"),
              HasSubstr("'kappa' reaches 0.01, where matter is opaque"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1.5, \"kappa\": 1e-6, \"thin\": true}"),
              HasSubstr("lacks the required key 'thickness'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1.5, \"thin\": true, \"roughness\": 0.1}"),
              HasSubstr("'thin' and 'roughness' exclude each other"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1.5, \"thin\": true, \"priority\": 2}"),
              HasSubstr("'thin' and 'priority' exclude each other"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1.5, \"roughness\": -1}"),
              HasSubstr("'roughness' is the number -1; expected a number of at least 0 (in material 'm')"));
}

}  // namespace
}  // namespace metamer
