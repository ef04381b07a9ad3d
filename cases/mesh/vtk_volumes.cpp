#include "cases/mesh/vtk_volumes.hpp"

#include "cases/mesh/inv3.hpp"
#include "cases/mesh/voxel_size.hpp"
#include "cases/mesh/vtk_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <type_traits>
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
#include <zlib.h>

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

void check_header(vtkMetaImageReader&, const std::string&) {}
void check_header(vtkNrrdReader&, const std::string&) {}

/// VTK's own reading of these headers knows no units and takes what is no number for 1 or for its beginning.
Eigen::Vector3d voxel_of(vtkMetaImageReader&, const VolumeBytes& bytes) {
  return bytes.voxel;
}
Eigen::Vector3d voxel_of(vtkNrrdReader&, const VolumeBytes& bytes) {
  return bytes.voxel;
}

std::string shown(const Eigen::Vector3d& edges) {
  std::ostringstream text;
  text << edges.x() << " x " << edges.y() << " x " << edges.z();
  return text.str();
}

/// The grid spacings of pixdim. The affine map of an sform leads to where the scanner or an aligned picture
/// has the voxels, and must agree; one to an atlas (codes 3 and up) need not where a qform leads to the
/// scanner.
Eigen::Vector3d voxel_of(vtkNIFTIImageReader& reader, const VolumeBytes&) {
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const Eigen::Vector3d edges(reader.GetDataSpacing());
  constexpr int of_atlas = 3;
  if (header.GetSFormCode() > 0 && !(header.GetSFormCode() >= of_atlas && header.GetQFormCode() > 0)) {
    Eigen::Matrix3d steps;
    double rows[3][4];
    header.GetSRowX(rows[0]);
    header.GetSRowY(rows[1]);
    header.GetSRowZ(rows[2]);
    for (int row = 0; row < 3; ++row)
      for (int a = 0; a < 3; ++a) steps(row, a) = rows[row][a];
    const Eigen::Vector3d by_map = edges_of_voxel(steps);
    if (!((by_map - edges).array().abs() <= voxel_tolerance * edges.array()).all())
      throw std::runtime_error("says voxels of " + shown(edges) + " by its pixdim and of " + shown(by_map) +
                               " by its sform, which must agree: set the one that is wrong");
  }
  constexpr std::array<const char*, 4> units{"", "m", "mm", "um"};
  const auto unit = static_cast<std::size_t>(header.GetXYZTUnits() & 7);
  return edges * millimetres_in(unit < units.size() ? units[unit] : "xyzt_units " + std::to_string(unit));
}

/// VTK takes the last bytes of a longer NRRD.
void check_length(vtkMetaImageReader&, const VolumeBytes&, std::uint64_t) {}
void check_length(vtkNIFTIImageReader&, const VolumeBytes&, std::uint64_t) {}
void check_length(vtkNrrdReader&, const VolumeBytes& bytes, std::uint64_t of_voxels) {
  if (!bytes.deflated && bytes.of_voxels != of_voxels)
    throw std::runtime_error("has " + std::to_string(bytes.of_voxels) + " bytes of voxels, must have " +
                             std::to_string(of_voxels));
}

/// The first number of a header, in either order of bytes, says which it is; VTK does not look at it.
void check_size_of_header(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"),
                                                        gzclose); // plain ones too
  std::array<unsigned char, 4> bytes{};
  const bool is_read = file && gzread(file.get(), bytes.data(), bytes.size()) == 4;
  const auto number = [&](auto begin) {
    return begin[0] + 256 * (begin[1] + 256 * (begin[2] + 256L * begin[3]));
  };
  for (const long size : {348L, 540L}) // of NIfTI-1 and NIfTI-2
    if (is_read && (number(bytes.begin()) == size || number(bytes.rbegin()) == size)) return;
  throw std::runtime_error(
      "is no NIfTI file: its first number, the size of its header, is neither 348 nor 540");
}

/// VTK takes other magic words for its elders, and what is no length for 1 mm.
void check_header(vtkNIFTIImageReader& reader, const std::string& path) {
  check_size_of_header(path);
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

/// What compressed voxels may hold: as much as the header says, but of NIfTI with its header, and any number
/// of pictures one after the other in time, the first of which is read.
template<class Reader>
void check_compressed(Reader& reader, const VolumeBytes& bytes, std::uint64_t of_voxels) {
  if (!bytes.deflated) return;
  std::uint64_t least = of_voxels;
  double n_pictures = 1;
  if constexpr (std::is_same_v<Reader, vtkNIFTIImageReader>) {
    vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
    least += static_cast<std::uint64_t>(std::clamp<std::int64_t>(header.GetVoxOffset(), 0, 1 << 30));
    for (int a = 4; a <= std::min<std::int64_t>(7, header.GetDim(0)); ++a)
      n_pictures *= std::clamp<double>(static_cast<double>(header.GetDim(a)), 1, 1e6);
  }
  constexpr double room = std::is_same_v<Reader, vtkNrrdReader> ? 0 : 1 << 20; // for what may follow
  const double most =
      std::min(room + n_pictures * static_cast<double>(least), static_cast<double>(bytes.of_voxels));
  check_deflated(*bytes.deflated, least, static_cast<std::uint64_t>(most));
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
Volume read_with_vtk(const std::string& path, const VolumeBytes& bytes) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  run_on(path, [&] { run_information(*reader); });
  Volume volume;
  const int* extent = reader->GetDataExtent();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<std::int64_t>(extent[2 * a + 1]) - extent[2 * a] + 1;
    volume.voxels[a] = n > 0 && n < std::numeric_limits<int>::max() ? static_cast<int>(n) : 0;
  }
  if (const int n = reader->GetNumberOfScalarComponents(); n != 1)
    throw std::runtime_error(
        "has " + std::to_string(n) +
        " numbers a voxel, must have one (a first axis of up to 9 in NRRD is taken for that)");
  check_header(*reader, path);
  volume.spacing = voxel_of(*reader, bytes);
  const int bytes_a_voxel = vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
  if (bytes_a_voxel < 1) throw std::runtime_error("has voxels of no type of numbers");
  const std::size_t n =
      checked_voxels(volume.voxels, volume.spacing, static_cast<std::size_t>(bytes_a_voxel), bytes.of_voxels);
  check_length(*reader, bytes, n * static_cast<std::size_t>(bytes_a_voxel));
  check_compressed(*reader, bytes, n * static_cast<std::size_t>(bytes_a_voxel));
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

Volume read_volume(const std::string& path, const VolumeBytes& bytes) {
  if (ends_with(path, ".inv3")) return read_inv3(path, bytes);
  if (ends_with(path, ".nrrd") || ends_with(path, ".nhdr")) return read_with_vtk<vtkNrrdReader>(path, bytes);
  if (ends_with(path, ".mha") || ends_with(path, ".mhd"))
    return read_with_vtk<vtkMetaImageReader>(path, bytes);
  return read_with_vtk<vtkNIFTIImageReader>(path, bytes);
}

} // namespace springproof::cases
