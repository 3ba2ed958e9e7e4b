// SPDX-License-Identifier: Apache-2.0
// Errors of the library as classes of scaleaxis.errors.
#include "scaleaxis/errors.hpp"

#include <nanobind/nanobind.h>

#include <exception>
#include <optional>
#include <string>

#include "bindings.hpp"

namespace scaleaxis::python {
namespace {

namespace nb = nanobind;

/// What files call themselves and what is in them need not be UTF-8.
nb::object text_of(const std::string& text) {
    return nb::steal(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

void raise(const char* name, const Error& error) {
    const Diagnostic& diagnostic = error.diagnostic();
    nb::object place = nb::none();
    if (diagnostic.place) {
        place = nb::make_tuple(diagnostic.place->x, diagnostic.place->y, diagnostic.place->z);
    }
    nb::object element = nb::none();
    if (!diagnostic.element.empty()) {
        element = text_of(diagnostic.element);
    }
    nb::object index = nb::none();
    if (diagnostic.index >= 0) {
        index = nb::int_(diagnostic.index);
    }
    const nb::module_ errors = nb::module_::import_("scaleaxis.errors");
    nb::list hints;
    for (const auto& [option, value] : diagnostic.hints) {
        hints.append(nb::make_tuple(option, value));
    }
    const nb::object message = errors.attr("with_hints")(text_of(diagnostic.message), hints);
    const nb::object type = errors.attr(name);
    const nb::object instance = type(message, diagnostic.code.c_str(), element, index, place);
    PyErr_SetObject(type.ptr(), instance.ptr());
}

void translate(const std::exception_ptr& error, void* /*payload*/) {
    try {
        std::rethrow_exception(error);
    } catch (const InvalidOption& known) {
        raise("InvalidOption", known);
    } catch (const FileError& known) {
        raise("FileError", known);
    } catch (const UnusableInput& known) {
        raise("UnusableInput", known);
    } catch (const InconsistentResult& known) {
        raise("InconsistentResult", known);
    } catch (const Cancelled& known) {
        raise("Cancelled", known);
    } catch (const Error& known) {
        raise("Error", known);
    }
}

}  // namespace

void bind_errors(nb::module_& /*m*/) { nb::register_exception_translator(translate); }

}  // namespace scaleaxis::python
