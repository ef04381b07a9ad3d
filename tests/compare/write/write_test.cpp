#include "compare/write/write.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

using namespace springproof;

namespace fs = std::filesystem;

namespace {

compare::Comparison one_cell_comparison() {
  compare::Comparison comparison;
  cases::Case definition;
  definition.name = "cell";
  definition.body = cases::Box{{1, 1, 1}, {1, 1, 1}};
  comparison.scene = cases::make_scene(definition);
  comparison.answers.msm.solution.status = cases::Status::converged;
  for (int n = 0; n < 8; ++n) comparison.answers.msm.solution.displacement.emplace_back(0.25 * n, 0, -1);
  comparison.answers.msm.solution.cell_volume = {1.5};
  comparison.answers.fem.solution.status = cases::Status::failed;
  comparison.answers.fem.solution.message = "limit point";
  comparison.measures = {{"L", "mm", std::nullopt, 2.5, std::nullopt}};
  return comparison;
}

/// Values of an appended raw array of a .vtu, found by name as ParaView does.
template<class Value>
std::vector<Value> read_array(const std::string& vtu, const std::string& name) {
  const std::size_t tag = vtu.find("Name=\"" + name + "\"");
  REQUIRE(tag != std::string::npos);
  const std::size_t offset = std::stoul(vtu.substr(vtu.find("offset=\"", tag) + 8));
  const char* block = vtu.data() + vtu.find("_", vtu.find("<AppendedData")) + 1 + offset;
  std::uint64_t size = 0;
  std::memcpy(&size, block, sizeof size);
  std::vector<Value> values(size / sizeof(Value));
  std::memcpy(values.data(), block + sizeof size, size);
  return values;
}

} // namespace

TEST_CASE("a .vtu carries the mesh in VTK's order and the fields of the sides that converged") {
  std::ostringstream out;
  compare::write_vtu(out, one_cell_comparison());
  const std::string vtu = out.str();
  CHECK(vtu.find("NumberOfPoints=\"8\" ") != std::string::npos);
  CHECK(vtu.find("NumberOfCells=\"1\"") != std::string::npos);
  CHECK(read_array<std::int64_t>(vtu, "connectivity") == std::vector<std::int64_t>{0, 1, 3, 2, 4, 5, 7, 6});
  CHECK(read_array<std::uint8_t>(vtu, "types") == std::vector<std::uint8_t>{12});
  const auto displacement = read_array<double>(vtu, "msm_displacement");
  REQUIRE(displacement.size() == 24);
  CHECK(displacement[21] == 1.75);
  CHECK(displacement[23] == -1);
  CHECK(read_array<double>(vtu, "msm_cell_volume") == std::vector<double>{1.5});
  CHECK(vtu.find("fem_displacement") == std::string::npos);
  CHECK(vtu.find("difference") == std::string::npos);
}

TEST_CASE("a failed side is a failed row with its reason, and its values are null, not numbers") {
  const auto document = nlohmann::json::parse(compare::to_json({one_cell_comparison()}).dump());
  CHECK(document["schema"] == 1);
  const auto& row = document["cases"][0];
  CHECK(row["status"] == "failed");
  CHECK(row["fem"]["status"] == "failed");
  CHECK(row["fem"]["message"] == "limit point");
  CHECK(row["measures"][0]["fem"].is_null());
  CHECK(row["measures"][0]["error_percent"].is_null());
  CHECK(row["measures"][0]["msm"] == 2.5);
  std::ostringstream csv;
  compare::write_csv(csv, {one_cell_comparison()});
  CHECK(csv.str() == "case,measure,unit,fem,msm,error_percent,fem_status,msm_status,"
                     "fem_discretisation_error_percent,peer,reference,fem_limit,fem_limit_uncertainty,"
                     "error_uncertainty_percent,error_same_mesh_percent\n"
                     "cell,L,mm,,2.5,,failed,converged,,,same_mesh,,,,\n");
}
