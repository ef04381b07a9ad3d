#include "compare/table/array_message.hpp"

#include <cstring>
#include <stdexcept>

namespace springproof::compare {

void ArrayMessage::add(const std::string& name, const NumberArray& array) {
  list_.push_back({{"name", name}, {"shape", {array.values.size() / array.columns, array.columns}}});
  bytes_.append(reinterpret_cast<const char*>(array.values.data()), array.values.size() * sizeof(double));
}

void ArrayMessage::add_mesh(const cases::Mesh& mesh, double length) {
  NumberArray nodes{3}, cells{mesh.shape == cases::CellShape::tetrahedron ? 4u : 8u};
  for (const Eigen::Vector3d& x : mesh.nodes) nodes.add({x.x() * length, x.y() * length, x.z() * length});
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) cells.add_nodes(mesh.cells[c]);
  add("nodes", nodes);
  add(cells.columns == 4 ? "tetrahedra" : "hexahedra", cells);
}

std::string ArrayMessage::text() {
  header["arrays"] = list_;
  return header.dump() + "\n" + bytes_;
}

ReadMessage read_array_message(const std::string& text) try {
  const std::size_t end = text.find('\n');
  ReadMessage message{Json::parse(text.substr(0, end)), {}};
  std::size_t at = end == std::string::npos ? text.size() : end + 1;
  for (const Json& one : message.header.at("arrays")) {
    const auto rows = one.at("shape").at(0).get<std::size_t>(),
               columns = one.at("shape").at(1).get<std::size_t>();
    const std::size_t left = (text.size() - at) / sizeof(double);
    if (columns == 0 || rows > left / columns)
      throw std::runtime_error("an array is longer than the message");
    NumberArray array{columns, std::vector<double>(rows * columns)};
    if (!array.values.empty())
      std::memcpy(array.values.data(), text.data() + at, array.values.size() * sizeof(double));
    at += array.values.size() * sizeof(double);
    message.arrays.emplace(one.at("name").get<std::string>(), std::move(array));
  }
  if (at != text.size()) throw std::runtime_error("bytes follow the last array");
  return message;
} catch (const Json::exception& error) {
  throw std::runtime_error(error.what());
}

} // namespace springproof::compare
