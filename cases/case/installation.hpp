#pragma once

#include <string>

/// Where the program's own files are. Nothing here is a path of the machine that built it: an installed
/// program can be moved as a whole.
namespace springproof::cases {

/// The program or shared object that this code is in.
std::string own_file();

/// A file that nobody but the program uses: it lies beside the file that this code is in (in a build) or in
/// that folder's subfolder springproof (installed).
std::string private_file(const std::string& name);

/// A part of the program that few commands need, with libraries that take long to start: a shared object of
/// its own, private_file(NAME.so), which is loaded at the first call.
/// @param name  the shared object's name, and that of the symbol it offers
/// @return the symbol's address
/// @throws std::system_error with the loader's reason
const void* load_shared_object(const std::string& name);

/// A folder of the data that come with the program. Its name was given to springproof_data() of CMake. It
/// lies in springproof_data beside the file that this code is in or, installed, in ../share/springproof.
/// @throws std::system_error if it is not where it was installed
std::string data_folder(const std::string& name);

} // namespace springproof::cases
