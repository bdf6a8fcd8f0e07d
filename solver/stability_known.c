/* stability_known.c - see stability_known.h.
 * SPDX-License-Identifier: MIT */
#include "stability_known.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

double known_parallel(double a, double b, double c)
{
    double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return 2 / (PI * x * y) * (log(p * q / sqrt(1 + x * x + y * y)) + x * q * atan(x / q) + y * p * atan(y / p)
                               - x * atan(x) - y * atan(y));
}

double known_perpendicular(double w, double h, double l)
{
    double W = w / l, H = h / l, s2 = W * W + H * H, s = sqrt(s2);
    double t = (1 + W * W) * (1 + H * H) / (1 + s2);
    double u = pow(W * W * (1 + s2) / ((1 + W * W) * s2), W * W), v = pow(H * H * (1 + s2) / ((1 + H * H) * s2), H * H);
    return (W * atan(1 / W) + H * atan(1 / H) - s * atan(1 / s) + 0.25 * log(t * u * v)) / (PI * W);
}

double known_strips(double w, double h)
{
    return sqrt(1 + h / w * (h / w)) - h / w;
}

/* A rectangle a x b with a corner above the point: odd in a and in b, so corners add with their signs. */
static double corner(double a, double b, double h)
{
    double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * PI);
}

double known_point(double x0, double x1, double y0, double y1, double h)
{
    return corner(x1, y1, h) - corner(x0, y1, h) - corner(x1, y0, h) + corner(x0, y0, h);
}

double known_penumbra(const double source[4], double h, const double blocker[4], double z)
{
    double hidden[4], f = known_point(source[0], source[1], source[2], source[3], h);
    int k;
    for (k = 0; k < 4; k += 2) {
        hidden[k] = fmax(source[k], blocker[k] * h / z);
        hidden[k + 1] = fmin(source[k + 1], blocker[k + 1] * h / z);
        if (hidden[k] >= hidden[k + 1])
            return f;
    }
    return f - known_point(hidden[0], hidden[1], hidden[2], hidden[3], h);
}
