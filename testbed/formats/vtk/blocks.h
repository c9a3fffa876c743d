#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace geoprior {

/// How a VTK XML file encodes its binary arrays: attributes of its root.
struct VtkEncoding {
  bool compressed = false;
  bool big_endian = false;
  std::size_t word_bytes = 4;  ///< of a header: UInt32 or UInt64
};

/// The header of a compressed array: number of blocks, size of a block, size of the last block or
/// 0, compressed size of each block. VTK 9.1 divides by the size, allocates and follows the rest.
/// A header that ends early is left to VTK, which notices.
///
/// @param data        bytes of the file from the header on
/// @param is_base64   else raw
/// @param most_bytes  that the whole array may have uncompressed
/// @param file_bytes  size of the file
/// @throws Error      naming `where`: numbers that contradict each other or the file's size
void check_block_header(std::string_view data, bool is_base64, const VtkEncoding& encoding,
                        double most_bytes, std::size_t file_bytes, const std::string& where);

}  // namespace geoprior
