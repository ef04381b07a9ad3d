#include "compare/provenance/digest.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

namespace springproof::compare {

std::string digest(const std::string& bytes) {
  unsigned char sum[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), sum);
  std::string digits;
  for (const unsigned char byte : sum) digits += fmt::format("{:02x}", byte);
  return digits;
}

} // namespace springproof::compare
