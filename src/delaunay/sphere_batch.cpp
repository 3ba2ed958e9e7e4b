// SPDX-License-Identifier: Apache-2.0
#include "delaunay/sphere_batch.hpp"

#include "base/compiler.hpp"

namespace scaleaxis::inline v1 {

namespace {

/// Twice the center is (la b × c + lb c × a + lc a × b) / det[a, b, c], with la = |a|² less the weight of a.
void spheres(std::size_t count, const double* SCALEAXIS_RESTRICT axs, const double* SCALEAXIS_RESTRICT ays,
             const double* SCALEAXIS_RESTRICT azs, const double* SCALEAXIS_RESTRICT bxs,
             const double* SCALEAXIS_RESTRICT bys, const double* SCALEAXIS_RESTRICT bzs,
             const double* SCALEAXIS_RESTRICT cxs, const double* SCALEAXIS_RESTRICT cys,
             const double* SCALEAXIS_RESTRICT czs, const double* SCALEAXIS_RESTRICT was,
             const double* SCALEAXIS_RESTRICT wbs, const double* SCALEAXIS_RESTRICT wcs, double* SCALEAXIS_RESTRICT xs,
             double* SCALEAXIS_RESTRICT ys, double* SCALEAXIS_RESTRICT zs, double* SCALEAXIS_RESTRICT errors,
             double* SCALEAXIS_RESTRICT margins) {
    constexpr double kEpsilon = 0x1p-53;
    for (std::size_t i = 0; i < count; ++i) {
        const double ax = axs[i], ay = ays[i], az = azs[i], bx = bxs[i], by = bys[i], bz = bzs[i], cx = cxs[i],
                     cy = cys[i], cz = czs[i];
        const double sa = ax * ax + ay * ay + az * az;
        const double sb = bx * bx + by * by + bz * bz;
        const double sc = cx * cx + cy * cy + cz * cz;
        const double la = sa - was[i], lb = sb - wbs[i], lc = sc - wcs[i];
        const double ux = by * cz - bz * cy, uy = bz * cx - bx * cz, uz = bx * cy - by * cx;
        const double vx = cy * az - cz * ay, vy = cz * ax - cx * az, vz = cx * ay - cy * ax;
        const double wx = ay * bz - az * by, wy = az * bx - ax * bz, wz = ax * by - ay * bx;
        const double volume = ax * ux + ay * uy + az * uz;
        const double inverse = 1 / volume;
        const double x = inverse * (la * ux + lb * vx + lc * wx);
        const double y = inverse * (la * uy + lb * vy + lc * wy);
        const double z = inverse * (la * uz + lb * vz + lc * wz);

        const double na = std::abs(ax) + std::abs(ay) + std::abs(az);
        const double nb = std::abs(bx) + std::abs(by) + std::abs(bz);
        const double nc = std::abs(cx) + std::abs(cy) + std::abs(cz);
        const double ma = sa + std::abs(was[i]), mb = sb + std::abs(wbs[i]), mc = sc + std::abs(wcs[i]);
        const double product = na * nb * nc;
        const double numerator = ma * nb * nc + mb * nc * na + mc * na * nb;
        const double size = std::abs(x) + std::abs(y) + std::abs(z);
        xs[i] = x;
        ys[i] = y;
        zs[i] = z;
        errors[i] = kEpsilon * ((28 * numerator + 20 * size * product) * std::abs(inverse) + 10 * size);
        margins[i] = std::abs(volume) - (32 * kEpsilon * product + 1e-150);
    }
}

}  // namespace

void SphereBatch::make_spheres(std::size_t count) {
    const auto column = [&](std::size_t k) { return values_.data() + k * capacity_; };
    spheres(count, column(0), column(1), column(2), column(3), column(4), column(5), column(6), column(7), column(8),
            column(9), column(10), column(11), column(12), column(13), column(14), column(15), column(16));
}

}  // namespace scaleaxis::inline v1
