using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Contact;
using HaptoFlow.Model;
using HaptoFlow.Numerics;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>A plain implementation of the native contact model's triangle mesh: it tests every triangle, and finds
    /// the side by angle-weighted pseudonormals. In Unity the physics engine does this. The tests need it to compare
    /// everything else with the golden file.</summary>
    internal sealed class GoldenMesh
    {
        private const double SameSideCosine = 0.7071;
        private const int Face = 6;

        private readonly Double3[] vertices;
        private readonly int[][] triangles;
        private readonly Double3[][] sides;

        public GoldenMesh(JsonValue raw)
        {
            vertices = raw["vertices"].AsArray()
                .Select(row => new Double3(row[0].AsNumber(), row[1].AsNumber(), row[2].AsNumber())).ToArray();
            triangles = raw["triangles"].AsArray()
                .Select(row => row.AsArray().Select(corner => corner.AsInteger()).ToArray()).ToArray();
            JoinVertices();
            sides = new Double3[triangles.Length][];
            FindSides();
            double volume = triangles.Sum(corners => Double3.Dot(
                vertices[corners[0]], Double3.Cross(vertices[corners[1]], vertices[corners[2]])));
            if (volume < 0.0)
            {
                throw new NotSupportedException("the golden mesh is inside out");
            }
        }

        /// <summary>For closed meshes only.</summary>
        public SurfacePoint? Closest(Double3 point, in HeldFace held)
        {
            Found found = Nearest(point, _ => true)!.Value;
            if (held.Normal.HasValue && Double3.Dot(found.Normal, held.Normal.Value) < SameSideCosine)
            {
                Double3 normal = held.Normal.Value;
                Found? kept = Facing(point, normal, SameSideCosine, 2.0);
                if (kept.HasValue && kept.Value.Behind && kept.Value.IsStraight)
                {
                    bool isAway = Double3.Dot(found.Normal, normal) < -SameSideCosine;
                    if (!found.Behind && isAway && held.Holds(kept.Value.Distance))
                    {
                        return new SurfacePoint(
                            kept.Value.Point, kept.Value.Normal, -kept.Value.Distance, found.Distance);
                    }
                    found = found.Behind ? HeldOrNearer(point, kept.Value, found, held) : found;
                }
            }
            return new SurfacePoint(found.Point, found.Normal, found.Behind ? -found.Distance : found.Distance);
        }

        public SurfaceEntry? EntryInto(Double3 from, Double3 to)
        {
            SurfaceEntry? first = null;
            for (int index = 0; index < triangles.Length; ++index)
            {
                int[] corners = triangles[index];
                Double3 normal = sides[index][Face];
                double towards = -Double3.Dot(to - from, normal);
                double height = Double3.Dot(from - vertices[corners[0]], normal);
                double share = height / towards;
                if (towards > 0.0 && height >= 0.0 && share <= 1.0 && !(share >= first?.Share))
                {
                    Double3 point = from + (to - from) * share;
                    (Double3 place, _) = TriangleGeometry.Closest(
                        vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], point);
                    if (Double3.Distance(point, place) <= 1e-10)
                    {
                        first = new SurfaceEntry(point, normal, share);
                    }
                }
            }
            return first;
        }

        private Found HeldOrNearer(Double3 point, Found kept, Found nearest, in HeldFace held)
        {
            Found? beside = Facing(point, kept.Normal, -SameSideCosine, SameSideCosine);
            if (beside.HasValue && held.Holds(kept.Distance))
            {
                if (Thickness(point, kept) < Thickness(point, beside.Value))
                {
                    return kept;
                }
                nearest = beside.Value;
            }
            return kept.Distance <= nearest.Distance + held.MarginMetres ? kept : nearest;
        }

        private double Thickness(Double3 point, Found side) =>
            side.Distance + (Facing(point, -side.Normal, SameSideCosine, 2.0)?.Distance ?? double.PositiveInfinity);

        private Found? Facing(Double3 point, Double3 direction, double lowest, double highest) =>
            Nearest(point, triangle =>
            {
                double cosine = Double3.Dot(sides[triangle][Face], direction);
                return cosine > lowest && cosine < highest;
            });

        private void JoinVertices()
        {
            foreach (int[] corners in triangles)
            {
                for (int corner = 0; corner < 3; ++corner)
                {
                    corners[corner] = Array.FindIndex(vertices, each => each.Equals(vertices[corners[corner]]));
                }
            }
        }

        private Found? Nearest(Double3 point, Func<int, bool> isCandidate)
        {
            double best = double.PositiveInfinity;
            Double3 nearest = Double3.Zero;
            Double3 side = Double3.Up;
            bool onFace = true;
            Double3 face = Double3.Up;
            for (int triangle = 0; triangle < triangles.Length; ++triangle)
            {
                if (!isCandidate(triangle))
                {
                    continue;
                }
                int[] corners = triangles[triangle];
                (Double3 place, int feature) = TriangleGeometry.Closest(
                    vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], point);
                double squared = Double3.Dot(point - place, point - place);
                if (squared < best)
                {
                    best = squared;
                    nearest = place;
                    side = sides[triangle][feature];
                    onFace = feature == Face;
                    face = sides[triangle][Face];
                }
            }
            return double.IsInfinity(best) ? (Found?)null : Describe(point, nearest, side, face, onFace);
        }

        private static Found Describe(Double3 point, Double3 nearest, Double3 side, Double3 face, bool onFace)
        {
            Double3 offset = point - nearest;
            bool behind = Double3.Dot(offset, side) < 0.0;
            Double3 normal = onFace || offset.Length < 1e-10 ? side : Vectors.UnitOr(behind ? -offset : offset, side);
            bool isStraight = onFace || Double3.Dot(side, face) > 0.9 || Double3.Dot(normal, face) > 1.0 - 1e-9;
            return new Found
            {
                Point = nearest, Normal = normal, Distance = offset.Length, Behind = behind, IsStraight = isStraight,
            };
        }

        private void FindSides()
        {
            var edges = new Dictionary<(int, int), Double3>();
            var cornerNormals = new Double3[vertices.Length];
            for (int index = 0; index < triangles.Length; ++index)
            {
                Double3 normal = FaceNormal(triangles[index]);
                for (int corner = 0; corner < 3; ++corner)
                {
                    (int here, int next, int before) = CornersFrom(index, corner);
                    edges[Key(here, next)] = edges.GetValueOrDefault(Key(here, next)) + normal;
                    Double3 leaving = Vectors.UnitOr(vertices[next] - vertices[here], normal);
                    Double3 arriving = Vectors.UnitOr(vertices[before] - vertices[here], normal);
                    cornerNormals[here] += normal * Math.Acos(Math.Clamp(Double3.Dot(leaving, arriving), -1.0, 1.0));
                }
            }
            for (int index = 0; index < triangles.Length; ++index)
            {
                Double3 normal = FaceNormal(triangles[index]);
                sides[index] = new Double3[7];
                sides[index][Face] = normal;
                for (int corner = 0; corner < 3; ++corner)
                {
                    (int here, int next, _) = CornersFrom(index, corner);
                    sides[index][corner] = Vectors.UnitOr(cornerNormals[here], normal);
                    sides[index][corner + 3] = Vectors.UnitOr(edges[Key(here, next)], normal);
                }
            }
        }

        private (int Here, int Next, int Before) CornersFrom(int triangle, int corner) =>
            (triangles[triangle][corner], triangles[triangle][(corner + 1) % 3], triangles[triangle][(corner + 2) % 3]);

        private Double3 FaceNormal(int[] corners) => Vectors.UnitOr(
            Double3.Cross(vertices[corners[1]] - vertices[corners[0]], vertices[corners[2]] - vertices[corners[0]]), Double3.Up);

        private static (int, int) Key(int from, int to) => (Math.Min(from, to), Math.Max(from, to));

        private struct Found
        {
            public Double3 Point;
            public Double3 Normal;
            public double Distance;
            public bool Behind;
            public bool IsStraight;
        }
    }

    internal static class TriangleGeometry
    {
        /// <summary>The point of a triangle nearest to another point, and the feature that it lies on: a corner (0 to
        /// 2), an edge (3: a-b, 4: b-c, 5: c-a) or the face (6). Found by the Voronoi regions of the features (Ericson,
        /// Real-Time Collision Detection, 5.1.5).</summary>
        public static (Double3 Place, int Feature) Closest(Double3 a, Double3 b, Double3 c, Double3 point)
        {
            Double3 ab = b - a;
            Double3 ac = c - a;
            double abA = Double3.Dot(ab, point - a);
            double acA = Double3.Dot(ac, point - a);
            if (abA <= 0.0 && acA <= 0.0)
            {
                return (a, 0);
            }
            double abB = Double3.Dot(ab, point - b);
            double acB = Double3.Dot(ac, point - b);
            if (abB >= 0.0 && acB <= abB)
            {
                return (b, 1);
            }
            double areaC = abA * acB - abB * acA;
            if (areaC <= 0.0 && abA >= 0.0 && abB <= 0.0)
            {
                return (a + ab * (abA / (abA - abB)), 3);
            }
            double abC = Double3.Dot(ab, point - c);
            double acC = Double3.Dot(ac, point - c);
            if (acC >= 0.0 && abC <= acC)
            {
                return (c, 2);
            }
            double areaB = abC * acA - abA * acC;
            if (areaB <= 0.0 && acA >= 0.0 && acC <= 0.0)
            {
                return (a + ac * (acA / (acA - acC)), 5);
            }
            double areaA = abB * acC - abC * acB;
            if (areaA <= 0.0 && acB - abB >= 0.0 && abC - acC >= 0.0)
            {
                return (b + (c - b) * ((acB - abB) / (acB - abB + abC - acC)), 4);
            }
            double area = areaA + areaB + areaC;
            return (a + ab * (areaB / area) + ac * (areaC / area), 6);
        }
    }
}
