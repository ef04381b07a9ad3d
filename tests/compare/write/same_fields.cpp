// Whether the pieces of a .pvtu are together a .vtu: every cell once, with the same points and the same
// fields.
//
// usage: springproof_same_fields WHOLE.vtu PIECES.pvtu TOLERANCE
//
// Both are read by VTK. A point is known by its position, to the last bit; a value may differ by the
// tolerance times the largest one of its field. Prints what was compared; exit status 1 and the reason if
// they differ.

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace {

using Position = std::array<double, 3>;

[[noreturn]] void differ(const std::string& how) {
  throw std::runtime_error(how);
}

template<class Reader>
vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& path) {
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!reader->GetOutput() || reader->GetOutput()->GetNumberOfCells() == 0) differ(path + " has no cells");
  return reader->GetOutput();
}

/// Numbers of the whole's points by their positions.
class Points {
 public:
  explicit Points(vtkUnstructuredGrid& whole) {
    for (vtkIdType p = 0; p < whole.GetNumberOfPoints(); ++p) numbers_.emplace(position(whole, p), p);
  }
  vtkIdType of(vtkUnstructuredGrid& grid, vtkIdType point) const {
    const auto found = numbers_.find(position(grid, point));
    if (found == numbers_.end()) differ("a point of a piece is none of the whole");
    return found->second;
  }
  std::size_t size() const { return numbers_.size(); }

 private:
  std::map<Position, vtkIdType> numbers_;
  static Position position(vtkUnstructuredGrid& grid, vtkIdType point) {
    Position at;
    grid.GetPoint(point, at.data());
    return at;
  }
};

/// The vertices' numbers in the whole, in the cell's order.
std::vector<vtkIdType> vertices_of(vtkUnstructuredGrid& grid, vtkIdType cell, const Points& points) {
  std::vector<vtkIdType> vertices;
  for (int v = 0; v < static_cast<int>(grid.GetCell(cell)->GetNumberOfPoints()); ++v)
    vertices.push_back(points.of(grid, grid.GetCell(cell)->GetPointId(v)));
  return vertices;
}

/// @param whole_number  number in the whole of each point, or cell, of the pieces
void compare(vtkDataSetAttributes& whole, vtkDataSetAttributes& pieces,
             const std::vector<vtkIdType>& whole_number, double tolerance) {
  if (whole.GetNumberOfArrays() != pieces.GetNumberOfArrays()) differ("the numbers of fields");
  for (int a = 0; a < whole.GetNumberOfArrays(); ++a) {
    vtkDataArray& expected = *whole.GetArray(a);
    vtkDataArray* const found = pieces.GetArray(expected.GetName());
    if (!found || found->GetNumberOfComponents() != expected.GetNumberOfComponents() ||
        found->GetDataType() != expected.GetDataType())
      differ(std::string("the field ") + expected.GetName());
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < whole_number.size(); ++n)
      for (int c = 0; c < expected.GetNumberOfComponents(); ++c) {
        const double value = expected.GetComponent(whole_number[n], c);
        if (!std::isfinite(value) || !std::isfinite(found->GetComponent(static_cast<vtkIdType>(n), c)))
          differ(std::string("a value that is no number, of ") + expected.GetName());
        largest = std::max(largest, std::abs(value));
        difference =
            std::max(difference, std::abs(found->GetComponent(static_cast<vtkIdType>(n), c) - value));
      }
    std::cout << expected.GetName() << ": largest " << largest << ", difference " << difference << '\n';
    if (!(difference <= tolerance * largest)) differ(std::string("values of ") + expected.GetName());
  }
}

} // namespace

int main(int argc, char** argv) try {
  if (argc != 4) differ("usage: springproof_same_fields WHOLE.vtu PIECES.pvtu TOLERANCE");
  const auto whole = read<vtkXMLUnstructuredGridReader>(argv[1]);
  const auto pieces = read<vtkXMLPUnstructuredGridReader>(argv[2]);
  const double tolerance = std::stod(argv[3]);
  const Points points(*whole);
  std::vector<vtkIdType> point_numbers, cell_numbers;
  for (vtkIdType p = 0; p < pieces->GetNumberOfPoints(); ++p) point_numbers.push_back(points.of(*pieces, p));
  if (std::set<vtkIdType>(point_numbers.begin(), point_numbers.end()).size() != points.size())
    differ("points are missing");
  std::map<std::vector<vtkIdType>, vtkIdType> cells;
  for (vtkIdType c = 0; c < whole->GetNumberOfCells(); ++c) cells.emplace(vertices_of(*whole, c, points), c);
  for (vtkIdType c = 0; c < pieces->GetNumberOfCells(); ++c) {
    const auto found = cells.find(vertices_of(*pieces, c, points));
    if (found == cells.end()) differ("a cell of a piece is none of the whole, or comes twice");
    cell_numbers.push_back(found->second);
    cells.erase(found);
  }
  if (!cells.empty()) differ("cells are missing");
  std::cout << point_numbers.size() << " points of pieces, " << points.size() << " of the whole, "
            << cell_numbers.size() << " cells\n";
  compare(*whole->GetPointData(), *pieces->GetPointData(), point_numbers, tolerance);
  compare(*whole->GetCellData(), *pieces->GetCellData(), cell_numbers, tolerance);
} catch (const std::exception& error) {
  std::cout << "not the same: " << error.what() << '\n';
  return 1;
}
