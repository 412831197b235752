// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/bag_chunk.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <memory>

namespace nadir::ros1 {
namespace {

bool unpack_bz2(std::string_view packed, std::string& into) {
  std::string source(packed);  // that library takes no const
  auto size = static_cast<unsigned>(into.size());
  return BZ2_bzBuffToBuffDecompress(into.data(), &size, source.data(),
                                    static_cast<unsigned>(source.size()), 0, 0) == BZ_OK &&
         size == into.size();
}

struct Lz4Closer {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

bool unpack_lz4(std::string_view packed, std::string& into) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) != 0U) return false;
  const std::unique_ptr<LZ4F_dctx, Lz4Closer> context(created);
  std::size_t written = 0;
  while (true) {
    std::size_t room = into.size() - written;
    std::size_t taken = packed.size();
    const std::size_t more = LZ4F_decompress(context.get(), into.data() + written, &room,
                                             packed.data(), &taken, nullptr);
    if (LZ4F_isError(more) != 0U) return false;
    written += room;
    packed.remove_prefix(taken);
    if (more == 0) return written == into.size();
    if (room == 0 && taken == 0) return false;  // cut off, or more than there is room for
  }
}

}  // namespace

std::optional<std::string> unpacked(std::string_view compression, std::string_view packed,
                                    std::size_t size) {
  std::string bytes(size, '\0');
  const bool done = compression == "bz2" ? unpack_bz2(packed, bytes)
                                         : compression == "lz4" && unpack_lz4(packed, bytes);
  return done ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace nadir::ros1
