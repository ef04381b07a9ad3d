#include "cases/mesh/gmsh_functions.hpp"

#include <fcntl.h>
#include <gmsh.h>
#include <stdexcept>

namespace springproof::cases {

namespace {

/// gmsh throws its messages.
template<class Function>
auto asked(const Function& function) {
  try {
    return function();
  } catch (const std::string& reason) {
    throw std::runtime_error("gmsh: " + reason);
  }
}

/// gmsh would run a script NAME.msh.opt beside a mesh; a mesh is therefore opened by its descriptor, beside
/// which there is none.
void open_file(const std::string& path, bool is_geometry) {
  asked([&] {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    if (is_geometry) {
      gmsh::open(path);
      gmsh::model::mesh::generate(3);
    } else {
      gmsh::open("/proc/self/fd/" + std::to_string(::open(path.c_str(), O_RDONLY)));
    }
  });
}

std::vector<GmshElements> elements_of(int dimension, int entity) {
  std::vector<int> types;
  std::vector<Tags> tags, nodes;
  asked([&] { gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity); });
  std::vector<GmshElements> all;
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (tags[t].empty()) continue;
    all.push_back({types[t], tags[t], {}});
    const auto n = static_cast<std::ptrdiff_t>(nodes[t].size() / tags[t].size());
    for (auto first = nodes[t].begin(); first != nodes[t].end(); first += n)
      all.back().nodes.emplace_back(first, first + n);
  }
  return all;
}

std::string type_name(int type) {
  std::string name;
  int dimension, order, n_nodes, n_primary;
  std::vector<double> local;
  asked([&] {
    gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  });
  return name;
}

GmshNodes nodes() {
  GmshNodes all;
  std::vector<double> parametric;
  asked([&] { gmsh::model::mesh::getNodes(all.tags, all.coordinates, parametric, -1, -1, false, false); });
  return all;
}

std::vector<GmshGroup> groups() {
  return asked([] {
    gmsh::vectorpair found;
    gmsh::model::getPhysicalGroups(found);
    std::vector<GmshGroup> all;
    for (const auto& [dimension, number] : found) {
      GmshGroup group{dimension, number, {}, {}};
      gmsh::model::getPhysicalName(dimension, number, group.name);
      gmsh::model::getEntitiesForPhysicalGroup(dimension, number, group.entities);
      all.push_back(std::move(group));
    }
    return all;
  });
}

} // namespace

const GmshFunctions springproof_gmsh{open_file, elements_of, type_name, nodes, groups};

} // namespace springproof::cases
