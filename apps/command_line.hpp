// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of commands: handles of what CLI11 keeps, with the part of its interface that the commands use. Its
/// headers take seconds to compile, so that only command_line.cpp, manual.cpp and program.cpp see them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming)
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace scaleaxis::app {

/// Tells what is wrong with the text of a value, which it may replace; empty: nothing.
using TextCheck = std::function<std::string(std::string& text)>;

/// Takes these texts and nothing else.
TextCheck is_one_of(std::vector<std::string> texts);

/// As the options of numbers are parsed. \returns whether it is a number
bool parse_value(const std::string& text, double& value);

/// One option of a command. Its functions return it, so that calls can be chained.
class Option {
   public:
    Option(CLI::Option* option) : option_(option) {}

    Option required(bool is_required = true) const;
    Option check(const TextCheck& check) const;
    /// Replaces the text of a value before it is checked and parsed.
    Option transform(const TextCheck& change) const;
    Option excludes(Option other) const;
    Option needs(Option other) const;
    /// Several values may be given as one text.
    Option delimiter(char separator) const;
    /// Each occurrence of the option takes one text, so that what follows is not taken for a value of it.
    Option one_text_each() const;
    Option expected(int count) const;
    /// The values as the help shows them; a blank for flags.
    Option value_text(const std::string& text) const;
    /// The heading under which the help lists it.
    Option group(const std::string& heading) const;

    /// How often it was given.
    std::size_t count() const;

   private:
    CLI::Option* option_;
};

/// The options of the program or of one of its subcommands.
class CommandLine {
   public:
    CommandLine(CLI::App& app) : app_(&app) {}

    CommandLine add_subcommand(const std::string& name, const std::string& description) const;
    /// For the types that command_line.cpp names. A path is an input, which no output may overwrite; outputs are texts.
    template <class Value>
    Option add_option(const std::string& names, Value& value, const std::string& description = "") const;
    /// `set` gets each value.
    template <class Value>
    Option add_option_function(const std::string& names, const std::function<void(const Value&)>& set,
                               const std::string& description) const;
    Option add_flag(const std::string& names, bool& value, const std::string& description) const;
    Option add_flag_callback(const std::string& names, const std::function<void()>& set,
                             const std::string& description) const;
    Option option(const std::string& name) const;
    void footer(const std::string& text) const;
    void on_parsed(const std::function<void()>& action) const;

    std::string name() const;
    /// Was this subcommand chosen?
    bool is_parsed() const;
    /// The names of the given options under a heading of the help.
    std::vector<std::string> given_options(const std::string& group) const;

   private:
    CLI::App* app_;
};

}  // namespace scaleaxis::app
