#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Native;
using HaptoFlow.Numerics;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Takes a relief from the surface of a sculpted mesh: its distance from the plane that its texture
    /// coordinates fit best. Main thread.</summary>
    internal static class MeshRelief
    {
        // A hole that is smaller is a seam between triangles.
        private const double MentionedHoles = 0.01;

        /// <summary>Bakes a mesh into a relief. Can be undone.</summary>
        /// <param name="scale">Of the object on which the relief is felt.</param>
        /// <returns>What the user has to know, as a sentence: why nothing was baked, or what is not known; null when
        /// all is well.</returns>
        public static string? Take(HapticRelief relief, Mesh mesh, Vector3 scale)
        {
            try
            {
                var plane = new SculptedPlane(mesh, scale.ToDouble());
                var map = new SculptedMap(plane);
                var heights = BakedHeights.OfMetres(map.Columns, map.Rows, map.HeightsMetres);
                Require(!heights.AreEven, "it is flat");
                const float Most = HapticRelief.MaximumDepthMillimetres;
                Require(heights.DepthMillimetres <= Most, FormattableString.Invariant(
                    $"its heights span {heights.DepthMillimetres:0} mm, and a relief has {Most:0} at most"));
                heights.SizeMetres = new Vector2((float)map.ColumnsMetres, (float)map.RowsMetres);
                (heights.Tiling, heights.Offset) = (map.Tiling, map.Offset);
                ReliefBake.Write(relief, heights);
                return map.HoleShare < MentionedHoles ? null : string.Format(CultureInfo.InvariantCulture,
                    "{0} has no surface on {1:0} % of its map: there the heights of the rims go on.", mesh.name,
                    100.0 * map.HoleShare);
            }
            catch (HaptoFlowException refusal)
            {
                return $"The mesh {mesh.name} was not baked, because {refusal.Message}.";
            }
        }

        /// <exception cref="HaptoFlowException">Otherwise.</exception>
        internal static void Require(bool isTrue, string otherwise)
        {
            if (!isTrue)
            {
                throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument, otherwise);
            }
        }
    }

    /// <summary>The plane that the texture coordinates of a mesh fit best, and the height of each vertex above it.
    /// </summary>
    internal sealed class SculptedPlane
    {
        // Of the mesh's size, by root mean squares. An arc of 25 degrees bows by as much.
        private const double MostShare = 0.05;

        private readonly double[] weights;
        private readonly Double3[] places;

        /// <exception cref="HaptoFlowException">The mesh is not readable, has no texture coordinates, or is curved.
        /// </exception>
        public SculptedPlane(Mesh mesh, Double3 scale)
        {
            MeshRelief.Require(
                mesh.isReadable, "it is not readable: switch on Read/Write in the model's import settings");
            MeshRelief.Require(Vectors.IsUsable(scale) && scale.X * scale.Y * scale.Z != 0.0,
                "its object has a scale of 0 or none");
            Triangles = mesh.triangles;
            Coordinates = mesh.uv;
            places = Array.ConvertAll(mesh.vertices, vertex => Double3.Scale(vertex.ToDouble(), scale));
            MeshRelief.Require(
                Coordinates.Length == places.Length && places.Length > 0, "it has no texture coordinates");
            MeshRelief.Require(places.All(Vectors.IsUsable) && Coordinates.All(
                each => Vectors.IsUsable(each.x) && Vectors.IsUsable(each.y)), "a vertex of it is nowhere");
            weights = Weights();
            (double u, double v, Double3 place) middle = Middle();
            (Columns, Rows) = Gradients(middle);
            Double3 normal = Double3.Cross(Columns, Rows);
            double unit = normal.Length;
            MeshRelief.Require(unit > 1e-9 * (Double3.Dot(Columns, Columns) + Double3.Dot(Rows, Rows)),
                "its texture coordinates do not lay it out as a surface");
            normal /= unit;
            // Whichever way the coordinates go, heights rise out of the front of the triangles; a mirrored object's
            // front is that of its mesh.
            bool isMirrored = scale.X * scale.Y * scale.Z < 0.0;
            normal = Double3.Dot(normal, FrontSum()) < 0.0 != isMirrored ? -normal : normal;
            Heights = new double[places.Length];
            Measure(middle, normal);
        }

        public int[] Triangles { get; }

        public Vector2[] Coordinates { get; }

        /// <summary>The way in the plane, in metres, for one unit of the first coordinate.</summary>
        public Double3 Columns { get; }

        /// <summary>The way in the plane, in metres, for one unit of the second coordinate.</summary>
        public Double3 Rows { get; }

        /// <summary>Of each vertex above the plane, in metres.</summary>
        public double[] Heights { get; }

        /// <summary>Twice the area of a triangle in the coordinates; below 0 where they are mirrored.</summary>
        public double CoordinateArea(int first)
        {
            Vector2 a = Coordinates[Triangles[first]];
            Vector2 b = Coordinates[Triangles[first + 1]];
            Vector2 c = Coordinates[Triangles[first + 2]];
            return ((double)b.x - a.x) * ((double)c.y - a.y) - ((double)b.y - a.y) * ((double)c.x - a.x);
        }

        /// <summary>The part of the map that belongs to each vertex: dense parts of a sculpture count no more than
        /// others.</summary>
        private double[] Weights()
        {
            var found = new double[places.Length];
            for (int first = 0; first + 2 < Triangles.Length; first += 3)
            {
                double area = Math.Abs(CoordinateArea(first));
                found[Triangles[first]] += area;
                found[Triangles[first + 1]] += area;
                found[Triangles[first + 2]] += area;
            }
            double sum = found.Sum();
            MeshRelief.Require(sum > 0.0, "its texture coordinates do not lay it out as a surface");
            return Array.ConvertAll(found, each => each / sum);
        }

        private (double U, double V, Double3 Place) Middle()
        {
            (double u, double v, Double3 place) = (0.0, 0.0, Double3.Zero);
            for (int index = 0; index < places.Length; ++index)
            {
                u += weights[index] * Coordinates[index].x;
                v += weights[index] * Coordinates[index].y;
                place += weights[index] * places[index];
            }
            return (u, v, place);
        }

        /// <summary>The least squares of places over coordinates.</summary>
        private (Double3 Columns, Double3 Rows) Gradients((double U, double V, Double3 Place) middle)
        {
            (double uu, double uv, double vv) = (0.0, 0.0, 0.0);
            (Double3 ofU, Double3 ofV) = (Double3.Zero, Double3.Zero);
            for (int index = 0; index < places.Length; ++index)
            {
                (double u, double v) = (Coordinates[index].x - middle.U, Coordinates[index].y - middle.V);
                Double3 place = places[index] - middle.Place;
                uu += weights[index] * u * u;
                uv += weights[index] * u * v;
                vv += weights[index] * v * v;
                ofU += weights[index] * u * place;
                ofV += weights[index] * v * place;
            }
            double determinant = uu * vv - uv * uv;
            MeshRelief.Require(determinant > 1e-12 * (uu + vv) * (uu + vv),
                "its texture coordinates do not lay it out as a surface");
            return ((vv * ofU - uv * ofV) / determinant, (uu * ofV - uv * ofU) / determinant);
        }

        /// <summary>The sum of the triangles' normals; the corners of a front face run clockwise.</summary>
        private Double3 FrontSum()
        {
            Double3 sum = Double3.Zero;
            for (int first = 0; first + 2 < Triangles.Length; first += 3)
            {
                Double3 corner = places[Triangles[first]];
                sum += Double3.Cross(
                    places[Triangles[first + 1]] - corner, places[Triangles[first + 2]] - corner);
            }
            return sum;
        }

        private void Measure((double U, double V, Double3 Place) middle, Double3 normal)
        {
            double extent = 0.0;
            double beside = 0.0;
            for (int index = 0; index < places.Length; ++index)
            {
                Double3 planned = InPlane(index, middle);
                Double3 off = places[index] - middle.Place - planned;
                Heights[index] = Double3.Dot(off, normal);
                Double3 aside = off - Heights[index] * normal;
                extent += weights[index] * Double3.Dot(planned, planned);
                beside += weights[index] * Double3.Dot(aside, aside);
            }
            RequireFlat("its texture does not lie evenly on it: it is off", Math.Sqrt(beside / extent));
            var bow = new Bow();
            double size = Math.Sqrt(extent);
            for (int index = 0; index < places.Length; ++index)
            {
                bow.Add(weights[index], (Coordinates[index].x - middle.U) * Columns.Length / size,
                    (Coordinates[index].y - middle.V) * Rows.Length / size, Heights[index] / size);
            }
            RequireFlat("it is curved: it bows", Math.Sqrt(bow.MeanSquare()));
        }

        private Double3 InPlane(int index, (double U, double V, Double3 Place) middle) =>
            (Coordinates[index].x - middle.U) * Columns + (Coordinates[index].y - middle.V) * Rows;

        private static void RequireFlat(string what, double share)
        {
            (double measured, double most) = (100.0 * share, 100.0 * MostShare);
            MeshRelief.Require(share <= MostShare, FormattableString.Invariant(
                $"{what} by {measured:0} % of its size, and a flat piece by {most:0} % at most"));
        }
    }

    /// <summary>How much of a surface's heights is one wide bow: the part that a quadratic function of its coordinates
    /// explains, which the shapes of a sculpture hardly do.</summary>
    internal sealed class Bow
    {
        private const int Terms = 6;

        private readonly double[,] products = new double[Terms, Terms + 1];
        private readonly double[] row = new double[Terms + 1];

        public void Add(double weight, double u, double v, double height)
        {
            (row[0], row[1], row[2], row[3], row[4], row[5]) = (1.0, u, v, u * u, u * v, v * v);
            row[Terms] = height;
            for (int one = 0; one < Terms; ++one)
            {
                for (int other = 0; other <= Terms; ++other)
                {
                    products[one, other] += weight * row[one] * row[other];
                }
            }
        }

        /// <summary>The mean square of the explained heights. A plane explains nothing of them, because they are those
        /// above the best plane.</summary>
        public double MeanSquare()
        {
            // Least squares by elimination: each pivot takes what its term explains beside those before it.
            double explained = 0.0;
            for (int pivot = 0; pivot < Terms; ++pivot)
            {
                double size = products[pivot, pivot];
                // A term that the others explain already, as on a strip.
                if (!(size > 1e-12))
                {
                    continue;
                }
                explained += products[pivot, Terms] * products[pivot, Terms] / size;
                for (int other = pivot + 1; other < Terms; ++other)
                {
                    double share = products[other, pivot] / size;
                    for (int column = pivot; column <= Terms; ++column)
                    {
                        products[other, column] -= share * products[pivot, column];
                    }
                }
            }
            return explained;
        }
    }

    /// <summary>The heights of a sculpted plane as a map over the part of the texture that the mesh covers.</summary>
    internal sealed class SculptedMap
    {
        private const int MostTexels = 1024;

        // The rims of triangles meet; only their insides may not.
        private const double Inside = 1e-6;
        private const double MostOverlap = 0.01;

        // The middles of texels lie on the edges of regular meshes, where no triangle has them inside.
        private const double BesideColumn = 0.01;
        private const double BesideRow = 0.007;

        // The tenth part of the triangles is smaller: they carry the details.
        private const double DetailShare = 0.1;

        private readonly SculptedPlane plane;
        private readonly (double U, double V) from;
        private readonly (double U, double V) span;
        private readonly float[] heights;
        private readonly byte[] covers;

        /// <exception cref="HaptoFlowException">The texture coordinates overlap.</exception>
        public SculptedMap(SculptedPlane plane)
        {
            this.plane = plane;
            int[] firsts = Enumerable.Range(0, plane.Triangles.Length / 3).Select(triangle => 3 * triangle)
                .Where(first => plane.CoordinateArea(first) != 0.0).ToArray();
            IEnumerable<Vector2> used = firsts.SelectMany(first => new[] { first, first + 1, first + 2 })
                .Select(corner => plane.Coordinates[plane.Triangles[corner]]);
            (float Left, float Right, float Bottom, float Top) box = used.Aggregate(
                (Left: float.MaxValue, Right: float.MinValue, Bottom: float.MaxValue, Top: float.MinValue),
                (all, each) => (Math.Min(all.Left, each.x), Math.Max(all.Right, each.x),
                    Math.Min(all.Bottom, each.y), Math.Max(all.Top, each.y)));
            from = (box.Left, box.Bottom);
            span = ((double)box.Right - box.Left, (double)box.Top - box.Bottom);
            double texelMetres = 0.5 * DetailMetres(firsts);
            Columns = TexelsOf(ColumnsMetres, texelMetres);
            Rows = TexelsOf(RowsMetres, texelMetres);
            heights = new float[Columns * Rows];
            covers = new byte[Columns * Rows];
            Array.ForEach(firsts, Fill);
            int covered = covers.Count(each => each > 0);
            double overlap = covers.Count(each => each > 1) / (double)Math.Max(1, covered);
            MeshRelief.Require(overlap <= MostOverlap, FormattableString.Invariant(
                $"its texture coordinates overlap on {100.0 * overlap:0} % of it, where the map has but one height"));
            HoleShare = 1.0 - covered / (double)heights.Length;
            HoleFilling.Fill(heights, Array.ConvertAll(covers, each => each > 0), Columns, Rows);
            float lowest = heights.Min();
            HeightsMetres = Array.ConvertAll(heights, height => height - lowest);
        }

        public int Columns { get; }

        public int Rows { get; }

        public double ColumnsMetres => span.U * plane.Columns.Length;

        public double RowsMetres => span.V * plane.Rows.Length;

        /// <summary>Of the map over the mesh's coordinates, of which it covers a part.</summary>
        public Vector2 Tiling => new Vector2((float)(1.0 / span.U), (float)(1.0 / span.V));

        /// <summary>Of the map over the mesh's coordinates.</summary>
        public Vector2 Offset => new Vector2((float)(-from.U / span.U), (float)(-from.V / span.V));

        /// <summary>Row by row from the bottom; the lowest is 0.</summary>
        public float[] HeightsMetres { get; }

        /// <summary>The part of the map without a triangle.</summary>
        public double HoleShare { get; }

        /// <summary>The length of an edge of the small triangles.</summary>
        private double DetailMetres(int[] firsts)
        {
            double squareMetres = Double3.Cross(plane.Columns, plane.Rows).Length;
            double[] edges = firsts.Select(first => Math.Sqrt(Math.Abs(plane.CoordinateArea(first)) * squareMetres))
                .OrderBy(edge => edge).ToArray();
            return edges[(int)(DetailShare * edges.Length)];
        }

        private static int TexelsOf(double metres, double texelMetres) =>
            (int)Math.Max(2.0, Math.Min(MostTexels, Math.Ceiling(metres / texelMetres - 1e-6)));

        /// <summary>Fills the texels whose middles a triangle covers.</summary>
        private void Fill(int first)
        {
            (int a, int b, int c) = (plane.Triangles[first], plane.Triangles[first + 1], plane.Triangles[first + 2]);
            (double X, double Y) one = Texel(a);
            (double X, double Y) two = Texel(b);
            (double X, double Y) three = Texel(c);
            double area = (two.X - one.X) * (three.Y - one.Y) - (two.Y - one.Y) * (three.X - one.X);
            int top = Math.Min(Rows - 1, (int)Math.Floor(Math.Max(one.Y, Math.Max(two.Y, three.Y)) + Inside));
            int right = Math.Min(Columns - 1, (int)Math.Floor(Math.Max(one.X, Math.Max(two.X, three.X)) + Inside));
            int left = Math.Max(0, (int)Math.Ceiling(Math.Min(one.X, Math.Min(two.X, three.X)) - Inside));
            int row = Math.Max(0, (int)Math.Ceiling(Math.Min(one.Y, Math.Min(two.Y, three.Y)) - Inside));
            for (; row <= top; ++row)
            {
                for (int column = left; column <= right; ++column)
                {
                    double ofTwo = ((column - one.X) * (three.Y - one.Y) - (row - one.Y) * (three.X - one.X)) / area;
                    double ofThree = ((two.X - one.X) * (row - one.Y) - (two.Y - one.Y) * (column - one.X)) / area;
                    double inside = Math.Min(1.0 - ofTwo - ofThree, Math.Min(ofTwo, ofThree));
                    if (inside >= -Inside)
                    {
                        Cover(row * Columns + column, inside, plane.Heights[a] +
                            ofTwo * (plane.Heights[b] - plane.Heights[a]) +
                            ofThree * (plane.Heights[c] - plane.Heights[a]));
                    }
                }
            }
        }

        private void Cover(int texel, double inside, double height)
        {
            heights[texel] = (float)height;
            covers[texel] = (byte)(covers[texel] == 0 || inside <= Inside ? Math.Max((byte)1, covers[texel]) : 2);
        }

        /// <summary>A vertex in texels: 0 is beside the middle of the first.</summary>
        private (double X, double Y) Texel(int vertex) => (
            (plane.Coordinates[vertex].x - from.U) / span.U * Columns - 0.5 - BesideColumn,
            (plane.Coordinates[vertex].y - from.V) / span.V * Rows - 0.5 - BesideRow);
    }

    /// <summary>Spans the holes of a map smoothly between their rims: the floor below a hole is not known, and a step
    /// at its rim would be felt.</summary>
    internal static class HoleFilling
    {
        // Each level of detail smooths what the coarser one found.
        private const int Sweeps = 8;

        /// <param name="isKnown">False in holes, whose values are replaced.</param>
        public static void Fill(float[] values, bool[] isKnown, int columns, int rows)
        {
            if (!Array.Exists(isKnown, each => each) || !Array.Exists(isKnown, each => !each))
            {
                return;
            }
            (int fewerColumns, int fewerRows) = ((columns + 1) / 2, (rows + 1) / 2);
            var coarse = new float[fewerColumns * fewerRows];
            var counts = new int[coarse.Length];
            for (int texel = 0; texel < values.Length; ++texel)
            {
                int place = texel / columns / 2 * fewerColumns + texel % columns / 2;
                coarse[place] += isKnown[texel] ? values[texel] : 0f;
                counts[place] += isKnown[texel] ? 1 : 0;
            }
            for (int place = 0; place < coarse.Length; ++place)
            {
                coarse[place] /= Math.Max(1, counts[place]);
            }
            Fill(coarse, Array.ConvertAll(counts, count => count > 0), fewerColumns, fewerRows);
            int[] holes = Enumerable.Range(0, values.Length).Where(texel => !isKnown[texel]).ToArray();
            foreach (int texel in holes)
            {
                values[texel] = coarse[texel / columns / 2 * fewerColumns + texel % columns / 2];
            }
            for (int sweep = 0; sweep < Sweeps; ++sweep)
            {
                foreach (int texel in holes)
                {
                    values[texel] = MeanBeside(values, texel, columns, rows);
                }
            }
        }

        /// <summary>The rims of the map are its neighbours' mirrors.</summary>
        private static float MeanBeside(float[] values, int texel, int columns, int rows)
        {
            (int row, int column) = (texel / columns, texel % columns);
            float left = values[texel - (column > 0 ? 1 : 0)];
            float right = values[texel + (column < columns - 1 ? 1 : 0)];
            float below = values[texel - (row > 0 ? columns : 0)];
            float above = values[texel + (row < rows - 1 ? columns : 0)];
            return 0.25f * (left + right + below + above);
        }
    }
}
