#include <fmt/format.h>

#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

class MaterialWriter {
 public:
  MaterialWriter(WriteContext& context, const Material& material) : context_(context), material_(material) {}

  JsonText write() {
    write_kind();
    if (material_.kind == MaterialKind::mix) return object_;  // its parts have bumps of their own
    if (material_.displacement != no_index) object_.add("displacement", context_.texture(material_.displacement));
    if (material_.normal_map != no_index)
      object_.add("normal_map",
                  JsonText::string(context_.folder + "/" + context_.texture_image_file(material_.normal_map).name));
    return object_;
  }

 private:
  JsonText write_kind() {
    switch (material_.kind) {
      case MaterialKind::diffuse: return diffuse();
      case MaterialKind::conductor: return conductor();
      case MaterialKind::dielectric: return dielectric();
      case MaterialKind::rough: return rough();
      case MaterialKind::coated: return coated();
      case MaterialKind::smooth: return smooth();
      case MaterialKind::layered: return layered();
      case MaterialKind::diffuse_transmission: return diffuse_transmission();
      case MaterialKind::mix: return mix();
      case MaterialKind::interface: type("interface"); return object_;
      case MaterialKind::hair: return hair();
    }
    return JsonText::object();
  }

  JsonText diffuse() {
    type("diffuse");
    reflectance();
    return object_;
  }

  JsonText conductor() {
    type("conductor");
    if (material_.reflectance_texture != no_index) {
      reflectance();
    } else {
      spectrum("eta", material_.eta);
      spectrum("kappa", material_.kappa);
    }
    roughness();
    fresnel();
    return object_;
  }

  JsonText dielectric() {
    type("dielectric");
    spectrum("eta", material_.eta);
    if (material_.kappa != zero_spectrum) spectrum("kappa", material_.kappa);
    roughness();
    inside();
    fresnel();
    return object_;
  }

  JsonText smooth() {
    type("smooth");
    spectrum("n", material_.eta);
    if (material_.kappa != zero_spectrum) spectrum("kappa", material_.kappa);
    inside();
    fresnel();
    return object_;
  }

  JsonText rough() {
    type("rough");
    spectrum("kd", material_.kd);
    spectrum("ks", material_.ks);
    object_.add("shininess", JsonText::number(material_.shininess));
    if (material_.normalized != 0) object_.add("normalized", JsonText::boolean(true));
    return object_;
  }

  JsonText coated() {
    type("coated");
    reflectance();
    spectrum("eta", material_.eta);
    roughness();
    fresnel();
    return object_;
  }

  JsonText layered() {
    const Layer& layer = material_.layer;
    type("layered");
    switch (layer.base) {
      case LayerBase::diffuse: reflectance(); break;
      case LayerBase::conductor:
        if (material_.reflectance_texture != no_index) {
          object_.add("base_reflectance", context_.texture(material_.reflectance_texture));
        } else {
          spectrum("base_eta", layer.base_eta);
          spectrum("base_kappa", layer.base_kappa);
        }
        varying_widths("base_roughness", layer.base_alpha_x, layer.base_alpha_y, layer.base_alpha_x_texture,
                       layer.base_alpha_y_texture);
        break;
    }
    spectrum("eta", material_.eta);
    roughness();
    object_.add("optical_thickness", number_or_texture(layer.thickness, layer.thickness_texture));
    if (layer.albedo_texture != no_index)
      object_.add("albedo", context_.texture(layer.albedo_texture));
    else if (layer.albedo != zero_spectrum)
      spectrum("albedo", layer.albedo);
    if (layer.asymmetry != 0 || layer.asymmetry_texture != no_index)
      object_.add("asymmetry", number_or_texture(layer.asymmetry, layer.asymmetry_texture));
    object_.add("max_depth", JsonText::integer(layer.max_depth));
    object_.add("walks", JsonText::integer(layer.walks));
    return object_;
  }

  JsonText hair() {
    const Hair& hair = material_.hair;
    type("hair");
    if (material_.reflectance_texture != no_index)
      reflectance();
    else
      spectrum("sigma_a", hair.sigma_a);
    object_.add("beta_m", JsonText::number(hair.beta_m));
    object_.add("beta_n", JsonText::number(hair.beta_n));
    object_.add("tilt", JsonText::number(hair.tilt_deg));
    spectrum("eta", material_.eta);
    return object_;
  }

  JsonText diffuse_transmission() {
    type("diffuse_transmission");
    reflectance();
    albedo("transmittance", material_.transmittance_texture, material_.transmittance);
    return object_;
  }

  JsonText mix() {
    type("mix");
    object_.add("first", JsonText::string(context_.material_names[material_.mix.first.index]));
    object_.add("second", JsonText::string(context_.material_names[material_.mix.second.index]));
    object_.add("amount", number_or_texture(material_.mix.amount, material_.mix.amount_texture));
    return object_;
  }

  void type(std::string_view name) { object_.add("type", JsonText::string(name)); }
  void spectrum(std::string_view key, SpectrumId id) { object_.add(key, context_.spectra.write(id)); }
  void albedo(std::string_view key, TextureId texture, SpectrumId id) {
    object_.add(key, texture != no_index ? context_.texture(texture) : context_.spectra.write_reflectance(id));
  }
  void reflectance() { albedo("reflectance", material_.reflectance_texture, material_.reflectance); }
  JsonText number_or_texture(float number, TextureId texture) {
    return texture != no_index ? context_.texture(texture) : JsonText::number(number);
  }
  void roughness() {
    varying_widths("roughness", material_.alpha_x, material_.alpha_y, material_.alpha_x_texture,
                   material_.alpha_y_texture);
  }
  void varying_widths(std::string_view key, float x, float y, TextureId x_texture, TextureId y_texture) {
    if (x_texture == no_index && y_texture == no_index) return widths(key, x, y);
    object_.add(key, JsonText::array().add(number_or_texture(x, x_texture)).add(number_or_texture(y, y_texture)));
  }
  void widths(std::string_view key, float x, float y) {
    if (x == 0 && y == 0) return;
    object_.add(key, x == y ? JsonText::number(x) : JsonText::numbers(std::array{x, y}));
  }
  void inside() {
    if (material_.priority != 0) object_.add("priority", JsonText::integer(material_.priority));
    if (material_.thin != 0) object_.add("thin", JsonText::boolean(true));
    if (material_.thickness != 0) object_.add("thickness", JsonText::number(material_.thickness));
  }
  void fresnel() {
    switch (material_.fresnel) {
      case FresnelModel::exact: return;
      case FresnelModel::schlick: object_.add("fresnel", JsonText::string("schlick"));
    }
  }

  WriteContext& context_;
  const Material& material_;
  JsonText object_ = JsonText::object();
};

// An entity that is only there for its material lends it its name; another one keeps its name for itself.
std::string wanted_name(const Scene& scene, Entity entity, uint32_t row) {
  const Name name = scene.registry.get<Name>(entity);
  const std::string own = name.name == no_index ? std::string() : scene.names[name.name];
  if (own.empty()) return fmt::format("material {}", row + 1);
  return scene.registry.has<Transform>(entity) || scene.registry.has<Geometry>(entity) ? own + " material" : own;
}

}  // namespace

JsonText write_materials(WriteContext& context) {
  const Table<Material>& table = context.scene.registry.table<Material>();
  // Names first: a mix may be of any others.
  for (uint32_t row = 0; row < table.size(); ++row) {
    const Entity entity = table.owner(row);
    if (entity.index >= context.material_names.size()) context.material_names.resize(entity.index + 1);
    context.material_names[entity.index] = context.entity_names.take(wanted_name(context.scene, entity, row));
  }
  JsonText materials = JsonText::object().break_lines();
  for (uint32_t row = 0; row < table.size(); ++row)
    materials.add(context.material_names[table.owner(row).index], MaterialWriter(context, table.get(row)).write());
  return materials;
}

}  // namespace metamer
