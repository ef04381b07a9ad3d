#pragma once

#include "cases/mesh/mesh.hpp"
#include "compare/table/json.hpp"

#include <map>
#include <vector>

/// What other programs are told, and answer: a line of JSON that lists the arrays after it, and these arrays
/// as little-endian doubles, row after row.
namespace springproof::compare {

/// Rows of numbers, one row after the other.
struct NumberArray {
  std::size_t columns;
  std::vector<double> values{};

  template<class Nodes>
  void add_nodes(const Nodes& nodes) {
    for (const int node : nodes) values.push_back(node);
  }
  void add(std::initializer_list<double> some) { values.insert(values.end(), some); }
};

struct NamedArray {
  std::string name;
  NumberArray array;
};

/// A message as it grows.
class ArrayMessage {
 public:
  Json header;

  void add(const std::string& name, const NumberArray& array);
  /// Adds "nodes", and "tetrahedra" or "hexahedra", whose vertices are in this project's order.
  /// @param length  how many of the message's units make a mm
  void add_mesh(const cases::Mesh& mesh, double length);
  std::string text();

 private:
  Json list_ = Json::array();
  std::string bytes_;
};

struct ReadMessage {
  Json header;
  std::map<std::string, NumberArray> arrays;
};

/// Reads a message of another program's.
/// @throws std::runtime_error if the line is no object that lists arrays, or other bytes follow it
ReadMessage read_array_message(const std::string& text);

} // namespace springproof::compare
