// Files of one body and one displacement, as VTK's writers leave them: write_foreign FOLDER
//
// 3 x 2 x 2 cells with a corner at (0.7, -0.3, 5) mm, 3.1 x 2.2 x 1.7 mm; u = (0.01 y z, 0.02 x, -0.01 x²).

#include <array>
#include <cmath>
#include <string>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkRectilinearGrid.h>
#include <vtkRectilinearGridWriter.h>
#include <vtkStructuredGrid.h>
#include <vtkStructuredGridWriter.h>
#include <vtkStructuredPointsWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace {

constexpr std::array<int, 3> n{3, 2, 2};
constexpr std::array<double, 3> corner{0.7, -0.3, 5}, spacing{3.1 / 3, 1.1, 0.85};

vtkIdType node(int i, int j, int k) {
  return i + (n[0] + 1) * (j + (n[1] + 1) * k);
}

template<class Action>
void for_each_node(const Action& action) {
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        action(corner[0] + i * spacing[0], corner[1] + j * spacing[1], corner[2] + k * spacing[2]);
}

/// The displacement, and what must not be taken for it.
template<class Array>
void add_fields(vtkDataSet& data) {
  vtkNew<Array> displacement, temperature;
  displacement->SetName("displacement");
  displacement->SetNumberOfComponents(3);
  temperature->SetName("temperature of the body");
  for_each_node([&](double x, double y, double z) {
    displacement->InsertNextTuple3(0.01 * y * z, 0.02 * x, -0.01 * x * x);
    temperature->InsertNextValue(37);
  });
  data.GetPointData()->AddArray(temperature);
  data.GetPointData()->AddArray(displacement);
}

template<class Array>
vtkNew<vtkPoints> all_points() {
  vtkNew<Array> array;
  array->SetNumberOfComponents(3);
  for_each_node([&](double x, double y, double z) { array->InsertNextTuple3(x, y, z); });
  vtkNew<vtkPoints> points;
  points->SetData(array);
  return points;
}

template<class Array>
vtkNew<Array> along(std::size_t axis) {
  vtkNew<Array> coordinates;
  for (int i = 0; i <= n[axis]; ++i) coordinates->InsertNextValue(static_cast<float>(0));
  for (int i = 0; i <= n[axis]; ++i) coordinates->SetComponent(i, 0, corner[axis] + i * spacing[axis]);
  return coordinates;
}

/// Every cell a hexahedron, or six tetrahedra around its diagonal.
template<class Array>
vtkNew<vtkUnstructuredGrid> unstructured(bool are_tetrahedra) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(all_points<Array>());
  grid->Allocate();
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::array<vtkIdType, 8> cell{
            node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
            node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
        if (!are_tetrahedra) {
          grid->InsertNextCell(VTK_HEXAHEDRON, 8, cell.data());
          continue;
        }
        const std::array<std::size_t, 7> around{1, 2, 3, 7, 4, 5, 1};
        for (std::size_t t = 0; t < 6; ++t) {
          const std::array<vtkIdType, 4> corners{cell[0], cell[around[t]], cell[around[t + 1]], cell[6]};
          grid->InsertNextCell(VTK_TETRA, 4, corners.data());
        }
        grid->InsertNextCell(VTK_QUAD, 4, cell.data()); // meshes with marked surfaces have such faces
      }
  add_fields<Array>(*grid);
  return grid;
}

template<class Writer>
void write_xml(vtkDataSet& data, const std::string& path) {
  vtkNew<Writer> writer;
  writer->SetInputData(&data);
  writer->SetFileName(path.c_str());
  writer->Write();
}

template<class Writer>
void write_legacy(vtkDataSet& data, const std::string& path) {
  for (const bool is_binary : {false, true})
    for (const int version : {42, 51}) {
      vtkNew<Writer> writer;
      writer->SetInputData(&data);
      writer->SetFileName(
          (path + (is_binary ? "_binary_" : "_text_") + std::to_string(version) + ".vtk").c_str());
      writer->SetFileVersion(version);
      is_binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
      writer->Write();
    }
}

/// Writes the grid in every mode and with every compressor.
void write_encodings(vtkUnstructuredGrid& grid, const std::string& path) {
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
    for (const int compressor :
         {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA})
      for (const bool is_encoded : {false, true}) {
        if (mode != vtkXMLWriter::Appended && !is_encoded) continue;
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetInputData(&grid);
        writer->SetDataMode(mode);
        writer->SetCompressorType(compressor);
        writer->SetEncodeAppendedData(is_encoded);
        writer->SetHeaderType(is_encoded ? vtkXMLWriter::UInt32 : vtkXMLWriter::UInt64);
        writer->SetFileName((path + "_" + std::to_string(mode) + std::to_string(compressor) +
                             (is_encoded ? "_encoded.vtu" : "_raw.vtu"))
                                .c_str());
        writer->Write();
      }
}

template<class Array>
void write_all(const std::string& folder, const std::string& precision) {
  const std::string ending = "_" + precision;
  const auto hexahedra = unstructured<Array>(false), tetrahedra = unstructured<Array>(true);
  write_encodings(*hexahedra, folder + "/hexahedra" + ending);
  write_xml<vtkXMLUnstructuredGridWriter>(*tetrahedra, folder + "/tetrahedra" + ending + ".vtu");
  write_legacy<vtkUnstructuredGridWriter>(*hexahedra, folder + "/hexahedra" + ending);

  vtkNew<vtkPolyData> surface;
  surface->SetPoints(all_points<Array>());
  vtkNew<vtkCellArray> points;
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p) points->InsertNextCell(1, &p);
  surface->SetVerts(points);
  add_fields<Array>(*surface);
  write_xml<vtkXMLPolyDataWriter>(*surface, folder + "/points" + ending + ".vtp");
  write_legacy<vtkPolyDataWriter>(*surface, folder + "/points" + ending);

  vtkNew<vtkStructuredGrid> structured;
  structured->SetDimensions(n[0] + 1, n[1] + 1, n[2] + 1);
  structured->SetPoints(all_points<Array>());
  add_fields<Array>(*structured);
  write_xml<vtkXMLStructuredGridWriter>(*structured, folder + "/structured" + ending + ".vts");
  write_legacy<vtkStructuredGridWriter>(*structured, folder + "/structured" + ending);

  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetDimensions(n[0] + 1, n[1] + 1, n[2] + 1);
  rectilinear->SetXCoordinates(along<Array>(0));
  rectilinear->SetYCoordinates(along<Array>(1));
  rectilinear->SetZCoordinates(along<Array>(2));
  add_fields<Array>(*rectilinear);
  write_xml<vtkXMLRectilinearGridWriter>(*rectilinear, folder + "/rectilinear" + ending + ".vtr");
  write_legacy<vtkRectilinearGridWriter>(*rectilinear, folder + "/rectilinear" + ending);

  vtkNew<vtkImageData> image;
  image->SetDimensions(n[0] + 1, n[1] + 1, n[2] + 1);
  image->SetOrigin(corner.data());
  image->SetSpacing(spacing.data());
  add_fields<Array>(*image);
  write_xml<vtkXMLImageDataWriter>(*image, folder + "/image" + ending + ".vti");
  write_legacy<vtkStructuredPointsWriter>(*image, folder + "/image" + ending);
}

} // namespace

int main(int, char** argv) {
  write_all<vtkDoubleArray>(argv[1], "double");
  write_all<vtkFloatArray>(argv[1], "float");
}
