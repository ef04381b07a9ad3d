#pragma once

class vtkAlgorithm;

namespace springproof::cases {

/// Runs a reader or writer of VTK's, which prints nothing.
/// @throws std::runtime_error with its first error, without the place in VTK's source
void run(vtkAlgorithm& algorithm);

/// The same of a reader that reads no more than what its file says of its content.
void run_information(vtkAlgorithm& algorithm);

} // namespace springproof::cases
