// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/npz.hpp>
#include <aib/io/npz_write.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_npz {

namespace {

const support::scratch scratch;

/// One member of a zip as it will lie in the file.
struct entry {
  std::string name;
  std::string content;  ///< as stored
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::uint16_t method = 0;
  std::uint16_t flags = 0;
  bool zip64 = false;
};

entry stored(const std::string& name, const std::string& content) {
  return {name + ".npy", content, content.size(), io::detail::crc32_of(content), 0, 0, false};
}

entry deflated(const std::string& name, const std::string& content) {
  z_stream stream = {};
  ::deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string packed(::deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  ::deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  ::deflateEnd(&stream);
  return {name + ".npy", packed, content.size(), io::detail::crc32_of(content), 8, 0, false};
}

/// The bytes of a zip file; the local headers of a streamed one (flag 8) hold no sizes.
std::string zip(const std::vector<entry>& entries) {
  std::string file;
  std::string directory;
  for (const entry& e : entries) {
    const auto offset = static_cast<std::uint32_t>(file.size());
    const bool streamed = (e.flags & 8) != 0;
    const auto packed = static_cast<std::uint32_t>(e.content.size());
    const auto size = static_cast<std::uint32_t>(e.size);
    io::store(file, std::uint32_t{0x04034b50});
    for (const int field : {20, int{e.flags}, int{e.method}, 0, 0})
      io::store(file, static_cast<std::uint16_t>(field));
    io::store(file, streamed ? 0 : e.crc);
    io::store(file, streamed ? 0 : packed);
    io::store(file, streamed ? 0 : size);
    io::store(file, static_cast<std::uint16_t>(e.name.size()));
    io::store(file, std::uint16_t{4});
    file += e.name + std::string(4, 'x') + e.content;  // an extra field that the directory has not

    std::string extra;
    if (e.zip64) {
      io::store(extra, std::uint16_t{1});
      io::store(extra, std::uint16_t{24});
      for (const std::uint64_t field :
           {e.size, std::uint64_t{e.content.size()}, std::uint64_t{offset}})
        io::store(extra, field);
    }
    io::store(directory, std::uint32_t{0x02014b50});
    for (const int field : {20, 20, int{e.flags}, int{e.method}, 0, 0})
      io::store(directory, static_cast<std::uint16_t>(field));
    io::store(directory, e.crc);
    io::store(directory, e.zip64 ? 0xffffffff : packed);
    io::store(directory, e.zip64 ? 0xffffffff : size);
    io::store(directory, static_cast<std::uint16_t>(e.name.size()));
    io::store(directory, static_cast<std::uint16_t>(extra.size()));
    directory += std::string(10, '\0');
    io::store(directory, e.zip64 ? 0xffffffff : offset);
    directory += e.name + extra;
  }
  const auto begin = static_cast<std::uint32_t>(file.size());
  file += directory;
  io::store(file, std::uint32_t{0x06054b50});
  io::store(file, std::uint32_t{0});
  io::store(file, static_cast<std::uint16_t>(entries.size()));
  io::store(file, static_cast<std::uint16_t>(entries.size()));
  io::store(file, static_cast<std::uint32_t>(directory.size()));
  io::store(file, begin);
  io::store(file, std::uint16_t{0});
  return file;
}

std::string npy(const std::vector<double>& values) {
  return io::npy_bytes(io::make_array<double>({values.size()}, values));
}

io::npz_file open(const std::vector<entry>& entries) {
  return io::npz_file(scratch.file("a.npz", zip(entries)));
}

std::string error_of(const std::vector<entry>& entries) {
  try {
    static_cast<void>(open(entries).read("x"));
  } catch (const error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

}  // namespace

TEST_CASE("stored, deflated, streamed and zip64 members are read") {
  std::vector<entry> entries{stored("a", npy({1, 2})), deflated("b", npy({3, 4, 5})),
                             stored("c", npy({6})), deflated("d", npy({7}))};
  entries[1].flags = 8;
  entries[3].zip64 = true;
  const io::npz_file file = open(entries);
  CHECK(file.names() == std::vector<std::string>{"a", "b", "c", "d"});
  CHECK(file.read("a").values<double>() == std::vector<double>{1, 2});
  CHECK(file.read("b").values<double>() == std::vector<double>{3, 4, 5});
  CHECK(file.read("c").values<double>() == std::vector<double>{6});
  CHECK(file.read("d").values<double>() == std::vector<double>{7});
  CHECK(file.read_header("b").shape == std::vector<std::size_t>{3});
  CHECK(io::read_npz(file.path(), "c")[0] == 6);
}

TEST_CASE("pickled members are listed and never loaded, other files are not listed") {
  std::string pickle = "\x93NUMPY\x01";
  pickle += '\0';
  const std::string header = "{'descr': '|O', 'fortran_order': False, 'shape': (), }\n";
  io::store(pickle, static_cast<std::uint16_t>(header.size()));
  pickle += header + "\x80\x04N.";
  entry note = stored("note", "text");
  note.name = "note.txt";
  const io::npz_file file = open({stored("good", npy({1})), stored("bad", pickle), note});
  CHECK(file.names() == std::vector<std::string>{"good", "bad"});
  CHECK_FALSE(file.is_unreadable("good"));
  CHECK(file.is_unreadable("bad"));
  CHECK_THROWS_WITH_AS(file.read("bad"),
                       doctest::Contains("a.npz[bad]: byte 24: npy: header: the elements are "
                                         "pickled Python objects, which are never loaded"),
                       format_error);
}

TEST_CASE("what a zip promises is held against what it has") {
  CHECK(error_of({stored("a", npy({1})), stored("b", npy({1}))}) ==
        "a.npz: npz: no array 'x'; there are: a, b");
  entry e = stored("x", npy({1}));
  e.crc ^= 1;
  CHECK(error_of({e}) == "a.npz: npz: 'x': the content does not fit its checksum");
  e = stored("x", npy({1}));
  e.method = 12;
  CHECK(error_of({e}) == "a.npz: npz: 'x': compression method 12 is not supported; 0 and 8 are");
  e = stored("x", npy({1}));
  e.flags = 1;
  CHECK(error_of({e}) == "a.npz: npz: 'x': encrypted");
  e = stored("x", npy({1}));
  e.size += 1;
  CHECK(error_of({e}) == "a.npz: npz: 'x': stored, but of two sizes");
  e = deflated("x", npy({1}));
  e.size += 1;
  CHECK(error_of({e}) == "a.npz: npz: 'x': 137 bytes expected, the deflated data holds 136");
  e = deflated("x", npy({1}));
  e.content[0] = '\x07';  // a block of a kind that deflate has not
  CHECK(error_of({e}) == "a.npz: npz: 'x': the deflated data is damaged");
  e = deflated("x", npy({1}));
  e.size = std::uint64_t{1} << 31;
  CHECK(error_of({e}).find("to 2147483648 bytes, which no array does") != std::string::npos);
}

TEST_CASE("a member that inflates suspiciously well is read below a limit of bytes") {
  const std::string zeros = npy(std::vector<double>(1 << 16));
  const auto path = scratch.file("bomb.npz", zip({deflated("x", zeros)}));
  CHECK(io::npz_file(path).read("x").size() == 1 << 16);
  CHECK_THROWS_WITH_AS(io::npz_file(path, {.max_bytes = 1 << 18}).read("x"),
                       doctest::Contains("which no array does"), format_error);
}

TEST_CASE("what is no zip, or half of one, is refused") {
  const std::string whole = zip({stored("x", npy({1}))});
  const auto refused = [](const std::string& bytes) {
    CHECK_THROWS_WITH_AS(io::npz_file(scratch.file("a.npz", bytes)),
                         doctest::Contains("a.npz: npz: not a zip file, or cut off"), format_error);
  };
  refused("");
  refused("PK\x03\x04");
  refused(whole.substr(0, whole.size() / 2));
}

TEST_CASE("arrays come back from the NPZ file that we write") {
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  const auto path = scratch.folder() / "out.npz";
  io::write_npz(path, {{"first", io::make_array<float>({2, 3}, values)},
                       {"second", io::make_array<float>({6}, values)}});
  const io::npz_file file(path);
  CHECK(file.names() == std::vector<std::string>{"first", "second"});
  CHECK(file.read("first").shape == std::vector<std::size_t>{2, 3});
  CHECK(file.read("second").values<float>() == values);
}

}  // namespace test_npz
