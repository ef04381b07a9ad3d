#include "cases/mesh/gmsh_model.hpp"

#include <fcntl.h>
#include <gmsh.h>
#include <stdexcept>

namespace springproof::cases {

namespace {

/// gmsh would run a script NAME.msh.opt beside a mesh; a mesh is therefore opened by its descriptor, beside
/// which there is none.
void open_file(const std::string& path, bool is_geometry) {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::open(is_geometry ? path : "/proc/self/fd/" + std::to_string(::open(path.c_str(), O_RDONLY)));
  if (is_geometry) gmsh::model::mesh::generate(3);
}

std::string name_of_type(int type) {
  std::string name;
  int dimension, order, n_nodes, n_primary;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  return name;
}

void add_elements(int dimension, int entity, GmshModel& model) {
  std::vector<int> types;
  std::vector<Tags> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  std::vector<GmshElements>& all = model.elements[{dimension, entity}];
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (tags[t].empty()) continue;
    all.push_back({types[t], std::move(tags[t]), std::move(nodes[t])});
    model.type_names[types[t]] = name_of_type(types[t]);
  }
}

GmshModel model_of_file(const std::string& path, bool is_geometry) try {
  open_file(path, is_geometry);
  GmshModel model;
  gmsh::vectorpair found;
  gmsh::model::getEntities(found);
  for (const auto& [dimension, entity] : found) add_elements(dimension, entity, model);
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(model.nodes, model.coordinates, parametric, -1, -1, false, false);
  gmsh::model::getPhysicalGroups(found);
  for (const auto& [dimension, number] : found) {
    GmshGroup& group = model.groups.emplace_back(GmshGroup{dimension, number, {}, {}});
    gmsh::model::getPhysicalName(dimension, number, group.name);
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, group.entities);
  }
  return model;
} catch (const std::string& reason) { // gmsh throws its messages
  throw std::runtime_error("gmsh: " + reason);
}

} // namespace

ReadGmsh* const springproof_gmsh = model_of_file;

} // namespace springproof::cases
