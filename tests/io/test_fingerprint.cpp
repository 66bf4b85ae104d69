// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/fingerprint.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace aib;

namespace test_fingerprint {

namespace {

std::string hash_of(std::string_view bytes) { return io::sha256().add(bytes).digest(); }

}  // namespace

// Source of the values: FIPS 180-2 appendix B, NIST CAVP SHA256ShortMsg (length 0).
TEST_CASE("sha256 gives the published digests") {
  CHECK(hash_of("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(hash_of("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(hash_of(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("sha256 does not depend on how the bytes are cut") {
  std::string bytes;
  for (int i = 0; i < 300; ++i) bytes += static_cast<char>(i);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    io::sha256 pieces;
    pieces.add(std::string_view(bytes).substr(0, cut)).add(std::string_view(bytes).substr(cut));
    CHECK(pieces.digest() == hash_of(bytes));
  }
}

TEST_CASE("every length around a block is padded") {
  // Each digest differs from all others: a lost or doubled padding byte would make two equal.
  std::string before;
  for (std::size_t n = 0; n < 200; ++n) {
    const std::string hash = hash_of(std::string(n, '\0'));
    CHECK(hash != before);
    before = hash;
  }
}

TEST_CASE("the fingerprint of a file is its size and its content's hash") {
  const auto path = std::filesystem::temp_directory_path() / "aib_test_fingerprint";
  const std::string content((std::size_t{1} << 20) + 7, 'x');
  io::write_file(path, content);
  const io::fingerprint f = io::fingerprint_of(path);
  std::filesystem::remove(path);
  CHECK(f.bytes == content.size());
  CHECK(f.sha256 == hash_of(content));
  CHECK_THROWS_AS(io::fingerprint_of(path), io_error);
}

}  // namespace test_fingerprint
