// SPDX-License-Identifier: Apache-2.0
// Vectors made of others, and disjoint sets by number, compared with the definition on random input.
#include "base/vectors.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <random>
#include <string>

#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace scaleaxis {
namespace {

TEST(Vectors, ItemsAreMappedChosenAndRemovedInOrder) {
    struct Named {
        std::string name;
        int age;
    };
    const std::vector<Named> all{{"a", 3}, {"b", 1}, {"c", 3}, {"d", 2}};
    EXPECT_EQ(each_of<int>(all, &Named::age), (std::vector{3, 1, 3, 2}));
    EXPECT_EQ(each_of<double>(all, [](const Named& one) { return 0.5 * one.age; }), (std::vector{1.5, 0.5, 1.5, 1.0}));
    EXPECT_EQ(indices_where(all.size(), [&](Index i) { return all[i].age > 1; }), (std::vector<Index>{0, 2, 3}));
    std::vector<int> items{5, 6, 7, 8};
    erase_marked(items, std::vector<char>{1, 0, 0, 1});
    EXPECT_EQ(items, (std::vector{6, 7}));
    items = {3, 1, 3, 2, 1};
    sort_unique(items);
    EXPECT_EQ(items, (std::vector{1, 2, 3}));
    const auto squares = mapped<double>(std::size_t{5000}, [](std::size_t i) { return static_cast<double>(i * i); });
    for (std::size_t i = 0; i < squares.size(); ++i) {
        ASSERT_EQ(squares[i], static_cast<double>(i * i));
    }
}

TEST(Vectors, OrderIsStableAndPlacesAreItsInverse) {
    std::mt19937 random(3);
    for (std::size_t count = 0; count < 40; ++count) {
        std::vector<unsigned> keys(count);
        std::ranges::generate(keys, [&] { return random() % 8; });
        const auto order = sorted_indices(
            count, [&](Index i) { return keys[i]; }, std::greater<>());
        ASSERT_EQ(order.size(), count);
        for (std::size_t k = 1; k < count; ++k) {
            const unsigned before = keys[order[k - 1]], after = keys[order[k]];
            ASSERT_TRUE(before > after || (before == after && order[k - 1] < order[k]));
        }
        const std::vector<Index> places = places_in(order);
        for (std::size_t k = 0; k < count; ++k) {
            ASSERT_EQ(places[order[k]], static_cast<Index>(k));
        }
    }
}

TEST(Vectors, SetsAreNumberedByTheirSmallestIndices) {
    std::mt19937 random(5);
    for (int round = 0; round < 50; ++round) {
        constexpr Index kCount = 30;
        DisjointSets sets(kCount);
        for (int i = 0; i < round; ++i) {
            sets.join(static_cast<Index>(random() % kCount), static_cast<Index>(random() % kCount));
        }
        const auto [numbers, count] = sets.numbered();
        const std::vector<Index> representatives = sets.all();
        std::map<Index, Index> seen;  // in the order of the smallest members
        for (Index i = 0; i < kCount; ++i) {
            ASSERT_EQ(representatives[i], sets.find(i));
            ASSERT_EQ(numbers[i], seen.try_emplace(sets.find(i), static_cast<Index>(seen.size())).first->second);
        }
        ASSERT_EQ(count, static_cast<Index>(seen.size()));
    }
}

TEST(Vectors, DirectionsAreOfLengthOneAndAtRightAngles) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Point direction = random_unit_vector(1, i, 0);
        ASSERT_NEAR(norm(direction), 1.0, 1e-14);
        const auto [u, v] = across(direction);
        for (const Point& normal : {any_normal_to(3.0 * direction), u, v}) {
            ASSERT_NEAR(norm(normal), 1.0, 1e-14);
            ASSERT_NEAR(dot(normal, direction), 0.0, 1e-14);
        }
        ASSERT_NEAR(dot(u, v), 0.0, 1e-14);
    }
}

}  // namespace
}  // namespace scaleaxis
