#pragma once

#include <Eigen/Core>

#include <plisse/picture/image.h>

namespace plisse {

/// Light, linear red, green and blue; 1 is the brightest that a picture shows.
using Color = Eigen::Vector3f;

/// From a number written as 0xRRGGBB in sRGB.
Color color_from_hex(unsigned hex);
Pixel to_pixel(const Color& color);

/// The front of body `body`, from 0; the colours repeat after eight bodies.
Color body_color(int body);
/// A body's surface when bodies are not told apart.
Color clay_color();
Color obstacle_color();
/// The back of a sheet whose front has the colour `front`: darker and cooler, so that folds read.
Color back_color(const Color& front);

/// A perceptual map from dark violet (0) over blue and green to light yellow (1); `share` is held to [0, 1].
/// Lightness rises evenly in OKLab (Ottosson 2020), so equal steps of the value look equally large.
Color map_color(double share);

} // namespace plisse
