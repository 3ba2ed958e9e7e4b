// SPDX-License-Identifier: Apache-2.0
#include "base/formats/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace scaleaxis::inline v1 {
namespace {

using Library = nlohmann::ordered_json;

// Deeper ones are refused: values are walked by recursion.
constexpr int kDeepest = 500;

[[noreturn]] void fail_as_no(const Json& value, const std::string& kind) {
    constexpr std::size_t kLongest = 60;
    throw JsonError(value.dump().substr(0, kLongest) + " is no " + kind);
}

}  // namespace

/// The same values as the library has them.
struct JsonText {
    static Library to_library(const Json& json) {
        if (const auto* elements = std::get_if<Json::Elements>(&json.value_)) {
            Library result = Library::array();
            for (const Json& element : *elements) {
                result.push_back(to_library(element));
            }
            return result;
        }
        if (const auto* members = std::get_if<Json::Members>(&json.value_)) {
            Library::object_t result;
            for (const auto& [name, member] : *members) {
                result.emplace_back(name, to_library(member));  // without a search for the name
            }
            return result;
        }
        return std::visit(
            [](const auto& value) -> Library {
                using Value = std::remove_cvref_t<decltype(value)>;
                if constexpr (std::is_same_v<Value, Json::Elements> || std::is_same_v<Value, Json::Members>) {
                    return nullptr;
                } else {
                    return value;
                }
            },
            json.value_);
    }

    static Json from_library(const Library& value) {
        switch (value.type()) {
            case Library::value_t::boolean:
                return value.get<bool>();
            case Library::value_t::number_integer:
                return value.get<std::int64_t>();
            case Library::value_t::number_unsigned:
                return value.get<std::uint64_t>();
            case Library::value_t::number_float:
                return value.get<double>();
            case Library::value_t::string:
                return value.get<std::string>();
            case Library::value_t::array: {
                Json::Elements elements;
                for (const Library& element : value) {
                    elements.push_back(from_library(element));
                }
                return Json(Json::Stored(std::move(elements)));
            }
            case Library::value_t::object: {
                Json::Members members;
                for (const auto& [name, member] : value.items()) {
                    members.emplace_back(name, from_library(member));
                }
                return Json(Json::Stored(std::move(members)));
            }
            default:
                return nullptr;
        }
    }
};

Json::Json(std::nullptr_t) noexcept {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(Stored value) noexcept : value_(std::move(value)) {}
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(Json other) noexcept {
    value_.swap(other.value_);
    return *this;
}
Json::~Json() = default;

Json::Json(std::initializer_list<Field> fields) {
    Members& members = value_.emplace<Members>();
    members.reserve(fields.size());
    for (const Field& field : fields) {
        members.emplace_back(field.name, std::move(field.value));
    }
}

Json::Json(std::initializer_list<double> numbers) : value_(Elements(numbers.begin(), numbers.end())) {}

Json Json::array(std::initializer_list<Json> elements) { return Json(Stored(Elements(elements))); }

Json Json::object() { return Json(Stored(Members())); }

Json Json::parse(std::string_view text, bool* is_valid) {
    const auto check_depth = [](int depth, Library::parse_event_t, const Library&) {
        if (depth > kDeepest) {
            throw JsonError("there is nothing as deep");
        }
        return true;
    };
    Library value;
    bool is_json = false;
    try {
        value = Library::parse(text, check_depth, false);
        is_json = !value.is_discarded();
    } catch (const JsonError&) {  // too deep
    }
    if (is_valid != nullptr) {
        *is_valid = is_json;
    }
    return is_json ? JsonText::from_library(value) : Json();
}

std::string Json::dump(int indent) const {
    return JsonText::to_library(*this).dump(indent, ' ', false, Library::error_handler_t::replace);
}

const std::string& Json::text() const {
    if (!is_string()) {
        fail_as_no(*this, "text");
    }
    return std::get<std::string>(value_);
}

double Json::number() const {
    if (const auto* real = std::get_if<double>(&value_)) {
        return *real;
    }
    if (const auto* large = std::get_if<std::uint64_t>(&value_)) {
        return static_cast<double>(*large);
    }
    return static_cast<double>(integer());
}

std::int64_t Json::integer() const {
    if (const auto* whole = std::get_if<std::int64_t>(&value_)) {
        return *whole;
    }
    fail_as_no(*this, "number of this kind");
}

bool Json::is_true() const {
    if (const auto* truth = std::get_if<bool>(&value_)) {
        return *truth;
    }
    fail_as_no(*this, "truth value");
}

std::size_t Json::size() const { return is_object() ? members().size() : elements().size(); }

const Json::Elements& Json::elements() const {
    if (!is_array()) {
        fail_as_no(*this, "array");
    }
    return std::get<Elements>(value_);
}

Json::Elements& Json::elements() { return const_cast<Elements&>(std::as_const(*this).elements()); }

const Json::Members& Json::members() const {
    if (!is_object()) {
        fail_as_no(*this, "object");
    }
    return std::get<Members>(value_);
}

const Json* Json::find(std::string_view name) const {
    const auto* members = std::get_if<Members>(&value_);
    if (members == nullptr) {
        return nullptr;
    }
    const auto member = std::ranges::find(*members, name, &Member::first);
    return member == members->end() ? nullptr : &member->second;
}

const Json& Json::at(std::string_view name) const {
    const Json* member = find(name);
    if (member == nullptr) {
        throw JsonError("there is no '" + std::string(name) + "' where one has to be");
    }
    return *member;
}

Json& Json::operator[](std::string_view name) {
    if (is_null()) {
        *this = object();
    }
    if (const Json* member = find(name)) {
        return const_cast<Json&>(*member);
    }
    members();  // which fails if it is no object
    return std::get<Members>(value_).emplace_back(name, nullptr).second;
}

void Json::erase(std::string_view name) {
    members();
    std::erase_if(std::get<Members>(value_), [&](const Member& member) { return member.first == name; });
}

void Json::update(const Json& other) {
    for (const auto& [name, member] : other.members()) {
        (*this)[name] = member;
    }
}

void Json::push_back(Json element) {
    if (is_null()) {
        *this = array();
    }
    elements().push_back(std::move(element));
}

bool Json::operator==(const Json& other) const { return value_ == other.value_; }

}  // namespace scaleaxis::inline v1
