// SPDX-License-Identifier: Apache-2.0
//
// The one source that knows librsvg, and cairo, which it draws with.
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis {
namespace {

constexpr double kPixels = 2.0;  // for each one of the picture, along both sides

template <class Type, auto kRelease>
struct Releaser {
    void operator()(Type* object) const { kRelease(object); }
};
template <class Type, auto kRelease>
using Owned = std::unique_ptr<Type, Releaser<Type, kRelease>>;

cairo_status_t append(void* closure, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

void check(bool is_done) {
    if (!is_done) {
        throw FileError("librsvg cannot draw the plot: write .svg");
    }
}

}  // namespace

std::string to_png(std::string_view svg) {
    const Owned<RsvgHandle, g_object_unref> picture(
        rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), nullptr));
    check(picture != nullptr);
    double width = 0.0;
    double height = 0.0;
    check(rsvg_handle_get_intrinsic_size_in_pixels(picture.get(), &width, &height) != 0);
    const Owned<cairo_surface_t, cairo_surface_destroy> surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(kPixels * width)),
                                   static_cast<int>(std::ceil(kPixels * height))));
    const Owned<cairo_t, cairo_destroy> canvas(cairo_create(surface.get()));
    const RsvgRectangle everywhere{0.0, 0.0, kPixels * width, kPixels * height};
    check(rsvg_handle_render_document(picture.get(), canvas.get(), &everywhere, nullptr) != 0);
    std::string png;
    check(cairo_surface_write_to_png_stream(surface.get(), append, &png) == CAIRO_STATUS_SUCCESS);
    return png;
}

}  // namespace scaleaxis
