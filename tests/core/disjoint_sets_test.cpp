#include "core/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace geoprior {
namespace {

TEST(DisjointSets, NumbersAreAloneUntilTheyAreJoined) {
  DisjointSets sets(4);
  EXPECT_EQ(sets.size(), 4);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(sets.find(i), i);
}

TEST(DisjointSets, TheLowestMemberRepresentsASetWhateverTheOrderOfJoins) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.join(5, 4), 4);
  EXPECT_EQ(sets.join(2, 5), 2);
  EXPECT_EQ(sets.join(4, 5), 2) << "of one set already";
  EXPECT_EQ(sets.join(1, 3), 1);
  EXPECT_EQ(sets.join(3, 4), 1);
  EXPECT_EQ(sets.find(0), 0);
  for (int i = 1; i < 6; ++i) EXPECT_EQ(sets.find(i), 1) << i;
}

TEST(DisjointSets, AgreeWithRelabelledListsOnRandomJoins) {
  constexpr int kCount = 200;
  DisjointSets sets(kCount);
  std::vector<int> label(kCount);
  for (int i = 0; i < kCount; ++i) label[i] = i;
  RandomStream random(7);
  for (int k = 0; k < 150; ++k) {
    const int i = static_cast<int>(random.below(kCount));
    const int j = static_cast<int>(random.below(kCount));
    sets.join(i, j);
    const auto [kept, given_up] = std::minmax(label[i], label[j]);
    std::replace(label.begin(), label.end(), int{given_up}, int{kept});
  }
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(sets.find(i), label[i]) << i;
}

}  // namespace
}  // namespace geoprior
