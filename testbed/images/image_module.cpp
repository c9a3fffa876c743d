#include <dlfcn.h>
#include <link.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "testbed/formats/input_file.h"
#include "testbed/images/image_codec.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "geoprior_images.so";
constexpr const char* kEntry = "geoprior_image_codec";
constexpr const char* kAllowed = "the module that was built with the program";

/// The loader maps a file that was cut off, and dies when it reads what is not there. The table of
/// sections is the last that a linker writes.
void require_whole(const fs::path& file) {
  std::ifstream in = open_input_file(file);
  ElfW(Ehdr) header{};
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in || std::string_view(reinterpret_cast<const char*>(header.e_ident), SELFMAG) != ELFMAG) {
    throw Error("is no shared object", file.string(), kAllowed);
  }
  const auto size = header.e_shoff + std::uintmax_t{header.e_shentsize} * header.e_shnum;
  if (fs::file_size(file) < size) throw Error("is cut off", file.string(), kAllowed);
}

/// Beside the program, or in lib/geoprior beside the bin that it was installed into.
fs::path module_file() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path installed = folder.parent_path() / "lib" / "geoprior" / kModule;
  const bool is_beside = fs::exists(folder / kModule) || !fs::exists(installed);
  return is_beside ? folder / kModule : installed;
}

const ImageCodec& open_module() {
  const fs::path file = module_file();
  require_whole(file);
  void* const module = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (module == nullptr) {
    throw Error("cannot be opened: " + std::string(::dlerror()), file.string(), kAllowed);
  }
  const auto entry = reinterpret_cast<const ImageCodec* (*)()>(::dlsym(module, kEntry));
  if (entry == nullptr) {
    ::dlclose(module);
    throw Error("is no module of images: it has no " + std::string(kEntry), file.string(),
                kAllowed);
  }
  return *entry();
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec& codec = open_module();
  return codec;
}

}  // namespace geoprior
