// SPDX-License-Identifier: Apache-2.0
#include "base/formats/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace scaleaxis {
namespace {

using Reference = nlohmann::ordered_json;

/// A random value, and the same of the reference.
struct Pair {
    Json own;
    Reference reference;
};

Pair random_pair(std::mt19937& random, int depth) {
    const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
    switch (below(depth > 0 ? 8 : 6)) {
        case 0:
            return {nullptr, nullptr};
        case 1:
            return {true, true};
        case 2: {
            const auto number = static_cast<std::int64_t>(random()) - (std::int64_t{1} << 31);
            return {number, number};
        }
        case 3:
            return {std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::uint64_t>::max()};
        case 4: {
            const double number = std::ldexp(static_cast<double>(random()), below(200) - 100);
            return {number, number};
        }
        case 5: {
            std::string text;
            for (int i = below(6); i > 0; --i) {
                text += static_cast<char>(below(256));  // hardly ever UTF-8
            }
            return {text, text};
        }
        case 6: {
            Pair result{Json::array(), Reference::array()};
            for (int i = below(5); i > 0; --i) {
                Pair element = random_pair(random, depth - 1);
                result.own.push_back(element.own);
                result.reference.push_back(element.reference);
            }
            return result;
        }
        default: {
            Pair result{Json::object(), Reference::object()};
            for (int i = below(5); i > 0; --i) {
                const std::string name = "member " + std::to_string(below(4));  // some of them twice
                Pair member = random_pair(random, depth - 1);
                result.own[name] = member.own;
                result.reference[name] = member.reference;
            }
            return result;
        }
    }
}

TEST(JsonValue, IsWrittenAsTheLibraryWritesIt) {
    for (unsigned seed = 1; seed <= 500; ++seed) {
        std::mt19937 random(seed);
        const Pair pair = random_pair(random, 4);
        for (const int indent : {-1, 2}) {
            const std::string text = pair.own.dump(indent);
            ASSERT_EQ(text, pair.reference.dump(indent, ' ', false, Reference::error_handler_t::replace)) << seed;
            ASSERT_EQ(Json::parse(text).dump(indent), text) << seed;
        }
    }
}

TEST(JsonValue, ListsAreFieldsOfAnObjectOrNumbers) {
    EXPECT_EQ((Json{{"a", 1}, {"b", {{"c", nullptr}}}}).dump(), R"({"a":1,"b":{"c":null}})");
    EXPECT_EQ((Json{{"pairs", {{"a", "b"}, {"c", "d"}}}}).dump(), R"({"pairs":{"a":"b","c":"d"}})");
    EXPECT_EQ((Json{{"place", {1.5, 2.0}}}).dump(), R"({"place":[1.5,2.0]})");
    EXPECT_EQ(Json::array({"a", 1, Json::array({2.0})}).dump(), R"(["a",1,[2.0]])");
    EXPECT_EQ(Json(std::vector<int>{1, 2}).dump(), "[1,2]");
    EXPECT_EQ(Json::array({Json{{"a", 1}}}).dump(), R"([{"a":1}])");
    EXPECT_EQ(Json(std::numeric_limits<double>::quiet_NaN()).dump(), "null");
}

TEST(JsonValue, EqualNumbersAreEqualWhateverTheirType) {
    EXPECT_EQ(Json(3U), Json(3));
    EXPECT_EQ(Json::parse("3"), Json(std::uint64_t{3}));
    EXPECT_FALSE(Json(3) == Json(4));
    EXPECT_FALSE(Json(3) == Json("3"));
}

TEST(JsonValue, MembersAreFoundChangedAndLeftOut) {
    Json json{{"a", 1}, {"b", "text"}};
    json["c"] = 2.5;
    json["a"] = 7;
    json.erase("b");
    json.update({{"c", true}, {"d", nullptr}});
    EXPECT_EQ(json.dump(), R"({"a":7,"c":true,"d":null})");
    EXPECT_EQ(json.value("a", 0), 7);
    EXPECT_EQ(json.value("x", 5), 5);
    EXPECT_EQ(json.find("x"), nullptr);
    EXPECT_EQ(json.size(), 3U);
}

TEST(JsonValue, SaysWhatIsNotWhatItHasToBe) {
    const auto message = [](const auto& action) {
        try {
            action();
        } catch (const JsonError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    const Json json{{"a", 1}, {"b", "text"}};
    EXPECT_EQ(message([&] { json.at("c"); }), "there is no 'c' where one has to be");
    EXPECT_EQ(message([&] { json.at("a").get<std::string>(); }), "1 is no text");
    EXPECT_EQ(message([&] { json.at("b").get<double>(); }), "\"text\" is no number of this kind");
    EXPECT_EQ(message([&] { json.elements(); }), R"({"a":1,"b":"text"} is no array)");
    EXPECT_EQ(message([&] { Json(1)["a"]; }), "1 is no object");
}

TEST(JsonValue, TextThatIsNoJsonOrTooDeepIsNull) {
    bool is_valid = true;
    for (const std::string& text : {std::string("{"), std::string("[1,]"), std::string(), std::string(1'000'000, '['),
                                    std::string(600, '[') + std::string(600, ']')}) {
        EXPECT_TRUE(Json::parse(text, &is_valid).is_null());
        EXPECT_FALSE(is_valid) << text.substr(0, 10);
    }
    EXPECT_TRUE(Json::parse("null", &is_valid).is_null());
    EXPECT_TRUE(is_valid);
    EXPECT_TRUE(Json::parse(std::string(400, '[') + std::string(400, ']'), &is_valid).is_array());
}

}  // namespace
}  // namespace scaleaxis
