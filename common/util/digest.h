#ifndef AIRDOS_COMMON_UTIL_DIGEST_H_
#define AIRDOS_COMMON_UTIL_DIGEST_H_

#include <cstddef>
#include <memory>
#include <string>

namespace airdos {

/// SHA-256 of everything added, as printed by `sha256sum`.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(Digest&&) noexcept;
  Digest& operator=(Digest&&) noexcept;

  void Add(const void* data, std::size_t size);
  /// Lower-case hexadecimal, 64 characters. More bytes may be added afterwards.
  std::string Hex() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_DIGEST_H_
