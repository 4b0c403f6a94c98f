#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int fuzz_mesh_builder(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_obj_text(const std::uint8_t* data, std::size_t size);

namespace {

// What a fuzzer found worth keeping: it ends the process where a promise does not hold.
void replay(const std::string& corpus, int (*fuzzer)(const std::uint8_t*, std::size_t)) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(HQ_CORPUS) / corpus)) {
    std::ifstream file(entry.path(), std::ios::binary);
    std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    bytes.shrink_to_fit();  // so that the sanitizers see a step beyond the end
    fuzzer(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(FuzzCorpus, MeshBuilderKeepsItsPromises) { replay("mesh_builder", fuzz_mesh_builder); }

TEST(FuzzCorpus, ObjTextKeepsItsPromises) { replay("obj_text", fuzz_obj_text); }

}  // namespace
