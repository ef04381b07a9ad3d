#include "cases/mesh/vtk_volumes.hpp"

#include "cases/mesh/inv3.hpp"
#include "cases/mesh/vtk_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>

namespace springproof::cases {

namespace {

/// The intensities as they are meant: the file's numbers, scaled.
struct Scale {
  double slope = 1, intercept = 0;
};

Scale scale_of(vtkNIFTIImageReader& reader) {
  return {reader.GetRescaleSlope(), reader.GetRescaleIntercept()};
}
Scale scale_of(vtkMetaImageReader& reader) {
  return {reader.GetRescaleSlope(), reader.GetRescaleOffset()};
}
Scale scale_of(vtkNrrdReader&) {
  return {};
}

void check_header(vtkMetaImageReader&) {}
void check_header(vtkNrrdReader&) {}

/// VTK takes other magic words for its elders, and what is no length for 1 mm.
void check_header(vtkNIFTIImageReader& reader) {
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const std::string magic = header.GetMagic() == nullptr ? "" : header.GetMagic();
  if (magic.rfind("n+1", 0) != 0 && magic.rfind("n+2", 0) != 0)
    throw std::runtime_error("is no NIfTI file with its voxels: its magic word is neither n+1 nor n+2");
  for (int a = 1; a <= std::min<std::int64_t>(3, header.GetDim(0)); ++a)
    if (const double length = header.GetPixDim(a); !(length > 0))
      throw std::runtime_error("has voxels of " + std::to_string(length) + " mm, must be above 0 mm");
  const int bits =
      8 * vtkDataArray::GetDataTypeSize(reader.GetDataScalarType()) * reader.GetNumberOfScalarComponents();
  if (header.GetBitPix() != bits)
    throw std::runtime_error("says " + std::to_string(header.GetBitPix()) + " bits a voxel, its type has " +
                             std::to_string(bits));
  const Scale scale = scale_of(reader);
  if (!std::isfinite(scale.slope) || !std::isfinite(scale.intercept))
    throw std::runtime_error("has a scale of its intensities that is no number");
}

/// VTK's messages name the file, objects and addresses, in several lines.
std::string in_one_line(std::string message, const std::string& path) {
  if (message.find("returned failure for request") != std::string::npos)
    return "is damaged or no such file, says VTK";
  if (const std::size_t at = message.find(path); at != std::string::npos) message.erase(at, path.size());
  return "VTK: " + message.substr(0, message.find('\n'));
}

/// What VTK says when it does something with a file.
template<class Action>
void run_on(const std::string& path, const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(in_one_line(error.what(), path));
  }
}

template<class Reader>
Volume read_with_vtk(const std::string& path, std::uint64_t most_bytes) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  run_on(path, [&] { run_information(*reader); });
  Volume volume;
  const int* extent = reader->GetDataExtent();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<std::int64_t>(extent[2 * a + 1]) - extent[2 * a] + 1;
    volume.voxels[a] = n > 0 && n < std::numeric_limits<int>::max() ? static_cast<int>(n) : 0;
    volume.spacing[static_cast<int>(a)] = reader->GetDataSpacing()[a];
  }
  if (const int n = reader->GetNumberOfScalarComponents(); n != 1)
    throw std::runtime_error(
        "has " + std::to_string(n) +
        " numbers a voxel, must have one (a first axis of up to 9 in NRRD is taken for that)");
  check_header(*reader);
  const int bytes_a_voxel = vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
  if (bytes_a_voxel < 1) throw std::runtime_error("has voxels of no type of numbers");
  const std::size_t n =
      checked_voxels(volume.voxels, volume.spacing, static_cast<std::size_t>(bytes_a_voxel), most_bytes);
  run_on(path, [&] { run(*reader); });
  vtkDataArray* numbers = reader->GetOutput()->GetPointData()->GetScalars();
  if (numbers == nullptr || static_cast<std::size_t>(numbers->GetNumberOfValues()) != n)
    throw std::runtime_error("has other voxels than it says");
  const Scale scale = scale_of(*reader);
  const bool is_scaled = scale.slope != 0;
  volume.intensities.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    const double number = numbers->GetComponent(static_cast<vtkIdType>(v), 0);
    volume.intensities[v] = static_cast<float>(is_scaled ? scale.slope * number + scale.intercept : number);
  }
  return volume;
}

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace

Volume read_volume(const std::string& path, std::uint64_t most_bytes) {
  if (ends_with(path, ".inv3")) return read_inv3(path, most_bytes);
  if (ends_with(path, ".nrrd") || ends_with(path, ".nhdr"))
    return read_with_vtk<vtkNrrdReader>(path, most_bytes);
  if (ends_with(path, ".mha") || ends_with(path, ".mhd"))
    return read_with_vtk<vtkMetaImageReader>(path, most_bytes);
  return read_with_vtk<vtkNIFTIImageReader>(path, most_bytes);
}

} // namespace springproof::cases
