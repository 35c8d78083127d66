#include "common/util/digest.h"

#include <openssl/evp.h>

#include <array>

#include "common/util/check.h"

namespace airdos {

struct Digest::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~Impl() { EVP_MD_CTX_free(context); }
};

Digest::Digest() : impl_(std::make_unique<Impl>()) {
  AIRDOS_CHECK(EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr) == 1);
}
Digest::~Digest() = default;
Digest::Digest(Digest&&) noexcept = default;
Digest& Digest::operator=(Digest&&) noexcept = default;

void Digest::Add(const void* data, std::size_t size) {
  AIRDOS_CHECK(EVP_DigestUpdate(impl_->context, data, size) == 1);
}

std::string Digest::Hex() const {
  Impl copy;
  AIRDOS_CHECK(EVP_MD_CTX_copy_ex(copy.context, impl_->context) == 1);
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
  unsigned int size = 0;
  AIRDOS_CHECK(EVP_DigestFinal_ex(copy.context, bytes.data(), &size) == 1);
  constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += kHex[bytes[i] >> 4];
    text += kHex[bytes[i] & 15];
  }
  return text;
}

}  // namespace airdos
