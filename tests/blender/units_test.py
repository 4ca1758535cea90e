"""Watts, angles, shapes of lights and media have their closed forms."""

import math
import unittest

from support import main, module

units, shapes, ies, media = (module(name) for name in ("units", "shapes", "ies", "media"))


class Units(unittest.TestCase):
    def test_a_sphere_far_away_is_a_point_of_the_same_power(self):
        radius = 0.2
        radiance = units.surface_radiance(50.0, 4.0 * math.pi * radius ** 2)
        self.assertAlmostEqual(radiance * math.pi * radius ** 2, units.point_intensity(50.0))

    def test_the_disc_of_a_sun_gives_its_irradiance(self):
        for angle in (0.01, 0.5, 2.0):
            steps, half = 4000, 0.5 * angle
            cosines = ((k + 0.5) / steps * half for k in range(steps))
            total = sum(2.0 * math.pi * math.cos(a) * math.sin(a) for a in cosines) * half / steps
            self.assertAlmostEqual(units.sun_radiance(3.0, angle) * total, 3.0, 5)

    def test_a_spot_falls_from_its_axis_to_its_edge(self):
        for blend in (0.0, 0.3, 1.0):
            values = [units.spot_falloff(math.radians(a), math.radians(60.0), blend) for a in (0.0, 10.0, 20.0, 29.9, 30.1)]
            self.assertEqual((values[0], values[-1]), (1.0, 0.0))
            self.assertEqual(values, sorted(values, reverse=True))

    def test_a_shift_is_a_part_of_a_larger_picture(self):
        for shift_x, shift_y in ((0.0, 0.0), (0.25, -0.1), (-0.3, 0.2)):
            (width, height), (x, y) = units.shifted_frame(100, 60, shift_x, shift_y, 100)
            self.assertEqual((x + 50 - width / 2, height / 2 - y - 30), (100 * shift_x, 100 * shift_y))
            self.assertTrue(0 <= x <= width - 100 and 0 <= y <= height - 60)

    def test_the_sensor_fits_the_wider_side(self):
        auto = units.vertical_fov(50.0, 36.0, 24.0, "AUTO", 200, 100)
        self.assertAlmostEqual(math.tan(0.5 * auto), 0.5 * 18.0 / 50.0)
        self.assertAlmostEqual(math.tan(0.5 * units.vertical_fov(50.0, 36.0, 24.0, "AUTO", 100, 200)), 0.5 * 36.0 / 50.0)
        self.assertAlmostEqual(math.tan(0.5 * units.vertical_fov(50.0, 36.0, 24.0, "VERTICAL", 200, 100)), 0.5 * 24.0 / 50.0)


class Shapes(unittest.TestCase):
    def test_areas(self):
        for shape, area in ((shapes.rectangle(), 1.0), (shapes.disc(), 0.25 * math.pi), (shapes.sphere(), 4.0 * math.pi)):
            self.assertAlmostEqual(shapes.area(*shape), area)

    def test_fronts_shine_along_z_or_outwards(self):
        def normal(points, triangle):
            a, b, c = (points[k] for k in triangle)
            u, v = ([q[i] - a[i] for i in range(3)] for q in (b, c))
            return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
        for points, triangles in (shapes.rectangle(), shapes.disc()):
            self.assertTrue(all(normal(points, t)[2] < 0.0 for t in triangles))
        points, triangles = shapes.sphere()
        self.assertTrue(all(sum(n * sum(points[k][i] for k in t) for i, n in enumerate(normal(points, t))) > 0.0 for t in triangles))

    def test_points_are_inside_and_balanced(self):
        points = shapes.points_in_disc(24)
        for axis in range(3):
            self.assertLess(abs(sum(p[axis] for p in points)) / len(points), 0.06)
        self.assertTrue(all(sum(x * x for x in p) < 1.0 + 1e-9 for p in points))


class Profiles(unittest.TestCase):
    def test_counts_fit_the_numbers(self):
        lines = ies.spot(1.0, 0.5).splitlines()
        count = int(lines[2].split()[3])
        self.assertEqual((len(lines[4].split()), len(lines[6].split())), (count, count))
        self.assertEqual(float(lines[6].split()[0]), 1.0)


class Media(unittest.TestCase):
    def test_attenuation_has_the_extinction(self):
        medium = media.attenuation([0.5, 2.0, 40.0])
        found = [-math.log(c) / medium["attenuationDistance"] for c in medium["attenuationColor"]]
        for value, expected in zip(found, (0.5, 2.0, 40.0)):
            self.assertAlmostEqual(value, expected, 6)

    def test_reflectance_rises_with_albedo(self):
        values = [media.reflectance_of(albedo) for albedo in (0.0, 0.3, 0.9, 0.99, 1.0)]
        self.assertEqual(values, sorted(values))
        self.assertLess(values[0], 1e-3)
        self.assertGreater(values[-1], 0.99)

    def test_white_volumes_only_scatter(self):
        extinction, albedo = media.principled_volume(2.0, (1.0, 0.5, 0.0), (0.0, 0.0, 1.0))
        self.assertEqual((extinction, albedo), ([2.0, 2.0, 0.0], [1.0, 0.5, 0.0]))


if __name__ == "__main__":
    main()
