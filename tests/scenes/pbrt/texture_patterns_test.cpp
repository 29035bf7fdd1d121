// Mappings and computed textures of pbrt files: what the scene then holds, and every message.
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using Kind = TextureMapping::Kind;
using testing::ElementsAre;
using testing::HasSubstr;

// The last texture of a file that names it "t" and uses it.
struct PatternRead {
  ReadScene read;
  explicit PatternRead(const std::string& world, const std::string& type = "spectrum")
      : read(read_text("Camera \"perspective\" WorldBegin\n" + world +
                       (type == "spectrum" ? "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"" : "") +
                       " Shape \"sphere\"")) {
    EXPECT_THAT(read.messages, ElementsAre());
  }
  Texture at(TextureId id) const { return read.scene.textures.at(id); }
  Texture last() const { return read.scene.textures.back(); }
  double spectrum(TextureId id) const { return read.scene.spectra.value(at(id).spectrum, 550); }
};

TEST(PbrtTexturePatterns, MappingsBelongToTheMatrixOfTheirMoment) {
  const std::string board = "Translate 1 2 3 Scale 2 2 2 Texture \"t\" \"spectrum\" \"checkerboard\" ";
  const PatternRead sphere(board + "\"string mapping\" \"spherical\"");
  EXPECT_EQ(sphere.last().mapping.kind, Kind::spherical);
  // x' = (x - 1) / 2
  EXPECT_EQ(sphere.last().mapping.to_texture[0], 0.5f);
  EXPECT_EQ(sphere.last().mapping.to_texture[3], -0.5f);
  EXPECT_EQ(sphere.last().mapping.to_texture[11], -1.5f);
  EXPECT_EQ(PatternRead(board + "\"string mapping\" \"cylindrical\"").last().mapping.kind, Kind::cylindrical);
  const PatternRead planar(board +
                           "\"string mapping\" \"planar\" \"vector3 v1\" [0 0 4] \"vector3 v2\" [5 0 0] \"float "
                           "udelta\" .5 \"float vdelta\" .25");
  EXPECT_EQ(planar.last().mapping.kind, Kind::planar);
  EXPECT_THAT(planar.last().mapping.u_axis, ElementsAre(0, 0, 4));
  EXPECT_THAT(planar.last().mapping.v_axis, ElementsAre(5, 0, 0));
  EXPECT_EQ(planar.last().mapping.u_offset, 0.5f);
  EXPECT_EQ(planar.last().mapping.v_offset, 0.25f);
  const PatternRead cubes(board + "\"integer dimension\" 3");
  EXPECT_EQ(cubes.last().mapping.kind, Kind::point);
  EXPECT_EQ(cubes.last().mapping.to_texture[0], 0.5f);
}

TEST(PbrtTexturePatterns, BilerpMixesFourCorners) {
  const PatternRead r(
      "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [.1 .1 .1] \"rgb v01\" [.2 .2 .2] \"rgb v10\" [.3 .3 .3] "
      "\"rgb v11\" [.4 .4 .4] \"float uscale\" 2");
  const Texture t = r.last(), left = r.at(t.a), right = r.at(t.b);
  EXPECT_EQ(t.kind, TextureKind::mix);
  EXPECT_NEAR(r.spectrum(left.a), 0.1, 1e-4);
  EXPECT_NEAR(r.spectrum(left.b), 0.2, 1e-4);
  EXPECT_NEAR(r.spectrum(right.a), 0.3, 1e-4);
  EXPECT_NEAR(r.spectrum(right.b), 0.4, 1e-4);
  EXPECT_EQ(r.at(t.amount).kind, TextureKind::coordinate);
  EXPECT_EQ(r.at(t.amount).axis, 0u);
  EXPECT_EQ(r.at(left.amount).axis, 1u);
  EXPECT_EQ(r.at(left.amount).mapping.u_scale, 2);
  const PatternRead plain("Texture \"t\" \"float\" \"bilerp\"", "float");  // by default t itself
  EXPECT_EQ(plain.at(plain.at(plain.last().a).a).value, 0);
  EXPECT_EQ(plain.at(plain.at(plain.last().a).b).value, 1);
}

TEST(PbrtTexturePatterns, DotsAndDirectionMixChooseBetweenTwo) {
  const PatternRead dots("Texture \"t\" \"float\" \"dots\" \"float inside\" .75 \"float outside\" .25", "float");
  EXPECT_EQ(dots.last().kind, TextureKind::mix);
  EXPECT_EQ(dots.at(dots.last().a).value, 0.25f);
  EXPECT_EQ(dots.at(dots.last().b).value, 0.75f);
  EXPECT_EQ(dots.at(dots.last().amount).kind, TextureKind::dots);
  const PatternRead facing(
      "Rotate 90 0 0 1 Texture \"t\" \"float\" \"directionmix\" \"vector3 dir\" [2 0 0] \"float tex1\" .7 \"float "
      "tex2\" .2",
      "float");
  EXPECT_EQ(facing.at(facing.last().b).value, 0.7f);  // where it faces the direction
  EXPECT_EQ(facing.at(facing.last().a).value, 0.2f);
  const Texture amount = facing.at(facing.last().amount);
  EXPECT_EQ(amount.kind, TextureKind::facing);
  EXPECT_NEAR(amount.axis_direction[0], 0, 1e-6);
  EXPECT_NEAR(amount.axis_direction[1], 1, 1e-6);
}

TEST(PbrtTexturePatterns, NoisesHaveOctavesAndRoughness) {
  for (const auto& [name, kind] : {std::pair{"fbm", TextureKind::fbm}, {"wrinkled", TextureKind::wrinkled}}) {
    const PatternRead r(
        std::string("Texture \"t\" \"float\" \"") + name + "\" \"integer octaves\" 5 \"float roughness\" .3", "float");
    EXPECT_EQ(r.last().kind, kind);
    EXPECT_EQ(r.last().octaves, 5u);
    EXPECT_EQ(r.last().roughness, 0.3f);
    EXPECT_EQ(r.last().mapping.kind, Kind::point);
  }
  EXPECT_EQ(PatternRead("Texture \"t\" \"float\" \"windy\"", "float").last().kind, TextureKind::windy);
  const PatternRead marble(
      "Scale 2 2 2 Texture \"t\" \"spectrum\" \"marble\" \"float scale\" 3 \"float variation\" .5");
  EXPECT_EQ(marble.last().kind, TextureKind::marble);
  EXPECT_EQ(marble.last().scale, 3);
  EXPECT_EQ(marble.last().variation, 0.5f);
  EXPECT_EQ(marble.last().octaves, 8u);
  EXPECT_EQ(marble.last().roughness, 0.5f);
  EXPECT_EQ(marble.last().mapping.to_texture[5], 0.5f);
}

TEST(PbrtTexturePatterns, MistakesAreSaidWithTheirLines) {
  const ReadScene read = read_text(
      "Camera \"perspective\" WorldBegin\n"
      "Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 65\n"
      "Texture \"b\" \"spectrum\" \"fbm\"\n"
      "Texture \"c\" \"float\" \"marble\"\n"
      "Texture \"d\" \"float\" \"directionmix\" \"vector3 dir\" [0 0 0]\n"
      "Texture \"e\" \"float\" \"dots\" \"string mapping\" \"planer\"\n"
      "Texture \"f\" \"float\" \"checkerboard\" \"integer dimension\" 4\n"
      "Texture \"g\" \"float\" \"dots\" \"string mapping\" \"spherical\" \"float uscale\" 2\n");
  EXPECT_FALSE(read.ok);
  EXPECT_THAT(read.messages,
              ElementsAre(HasSubstr("2: error: Texture \"fbm\": expected at most 64 octaves, not 65"),
                          HasSubstr("3: error: texture \"fbm\" makes values of type \"float\""),
                          HasSubstr("4: error: texture \"marble\" makes values of type \"spectrum\""),
                          HasSubstr("5: error: Texture \"directionmix\": a direction of length 0"),
                          HasSubstr("6: error: Texture \"dots\": there is no mapping \"planer\" (did you mean"),
                          HasSubstr("7: error: Texture \"checkerboard\": expected 2 or 3, not 4"),
                          HasSubstr("8: error: Texture \"dots\" has no parameter 'float uscale'")));
}

}  // namespace
}  // namespace metamer
