#include "cases/case/installation.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <link.h>
#include <system_error>

namespace springproof::cases {

namespace fs = std::filesystem;

namespace {

/// dlopen() and dlsym() say why in words, not in a number.
[[noreturn]] void fail() {
  const char* const reason = dlerror();
  throw std::system_error(ELIBACC, std::generic_category(),
                          reason ? reason : "a shared object of the program");
}

/// Where this function is.
const fs::path& own_path() {
  static const fs::path path = [] {
    Dl_info unused{};
    link_map* object = nullptr;
    const auto* const here = reinterpret_cast<const void*>(&own_path);
    if (dladdr1(here, &unused, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) == 0) fail();
    const std::string name = object->l_name; // a program's is empty
    return fs::canonical(name.empty() ? "/proc/self/exe" : name);
  }();
  return path;
}

fs::path own_folder() {
  return own_path().parent_path();
}

} // namespace

std::string own_file() {
  return own_path().string();
}

std::string private_file(const std::string& name) {
  std::error_code none;
  const fs::path installed = own_folder() / "springproof" / name;
  return (fs::exists(installed, none) ? installed : own_folder() / name).string();
}

const void* load_shared_object(const std::string& name) {
  // Local: other libraries must not take its symbols, or those of what it is linked to, for theirs. Lazy:
  // most functions of the libraries behind it are never called.
  void* const object = dlopen(private_file(name + ".so").c_str(), RTLD_LAZY | RTLD_LOCAL);
  const void* const symbol = object ? dlsym(object, name.c_str()) : nullptr;
  if (!symbol) fail();
  return symbol;
}

std::string data_folder(const std::string& name) {
  std::error_code none;
  const fs::path built = own_folder() / "springproof_data" / name;
  return fs::canonical(fs::exists(built, none) ? built
                                               : own_folder().parent_path() / "share" / "springproof" / name)
      .string();
}

} // namespace springproof::cases
