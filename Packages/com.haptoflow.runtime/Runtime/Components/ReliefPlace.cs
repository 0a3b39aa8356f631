#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Where a place on a collider lies in the map of a relief. Main thread, no garbage.</summary>
    internal static class ReliefPlace
    {
        /// <summary>Completes a contact state with the relief that it touches. Without one, and where the collider has
        /// no place in its map, the state has none.</summary>
        public static void Write(NearbyCollider? touched, ref ContactReading reading)
        {
            HapticRelief? relief = touched?.Felt.Relief;
            if (relief is null || relief.Number == 0)
            {
                return;
            }
            Double3 normal = Double3.Cross(Vector(reading.State.FirstAxis), Vector(reading.State.SecondAxis));
            if (!TryFind(
                relief, touched!.Collider!, touched.Tracked.Frame, touched.Place, normal, out MapPlace place))
            {
                return;
            }
            reading.State.Relief = relief.Number;
            reading.State.ReliefShare = relief.Share;
            reading.State.ReliefPlace = place;
        }

        /// <summary>Where a place on a collider lies in the map; false where the collider has none.</summary>
        /// <param name="frame">Has the grain of what is touched.</param>
        /// <param name="outward">The normal in the collider's local frame.</param>
        public static bool TryFind(HapticRelief relief, Collider collider, TangentFrame frame, in TouchedPlace touched,
            Double3 outward, out MapPlace found)
        {
            Vector2 size = relief.SizeMetres;
            Double3 place = touched.LocalMetres;
            switch (collider)
            {
                case BoxCollider box:
                    Double3 centre = Double3.Scale(box.center.ToDouble(), box.transform.lossyScale.ToDouble());
                    Double3 normal = FaceOf(outward);
                    Double3 columns = frame.FirstAxisOfNewTouch(normal);
                    // Seen from outside, in Unity's left-handed space, the rows go up where the columns go right.
                    Double3 rows = Double3.Cross(columns, normal);
                    found = new MapPlace(0.5 + Double3.Dot(place - centre, columns) / size.x,
                        0.5 + Double3.Dot(place - centre, rows) / size.y);
                    return true;
                case TerrainCollider _:
                    found = new MapPlace(place.X / size.x + relief.Offset.x, place.Z / size.y + relief.Offset.y);
                    return true;
                default:
                    found = default;
                    if (!touched.TryGetMesh(out Mesh mesh) || !MeshCoordinates.Of(mesh).TryFind(
                        touched, collider.transform.lossyScale.ToDouble(), out found))
                    {
                        return false;
                    }
                    found = new MapPlace(relief.Tiling.x * found.Column + relief.Offset.x,
                        relief.Tiling.y * found.Row + relief.Offset.y);
                    return true;
            }
        }

        /// <summary>The face of a box to which a normal belongs: beside an edge it points between two faces.</summary>
        private static Double3 FaceOf(Double3 normal)
        {
            Double3 size = normal.Absolute;
            int axis = size.X >= size.Y && size.X >= size.Z ? 0 : size.Y >= size.Z ? 1 : 2;
            return Double3.Zero.With(axis, normal[axis] < 0.0 ? -1.0 : 1.0);
        }

        private static Double3 Vector(in PlaceVector vector) => new Double3(vector.X, vector.Y, vector.Z);
    }

    /// <summary>The triangles of a mesh with their texture coordinates, read once. Main thread; no garbage for a known
    /// mesh. A mesh that a script changes later keeps those that it had.</summary>
    internal sealed class MeshCoordinates
    {
        private static readonly ObjectCache<Mesh, MeshCoordinates> Known = new ObjectCache<Mesh, MeshCoordinates>();

        private readonly int[] triangles;
        private readonly Vector3[] vertices;
        private readonly Vector2[] coordinates;

        public MeshCoordinates(Mesh mesh) =>
            (triangles, vertices, coordinates) = (mesh.triangles, mesh.vertices, mesh.uv);

        public static MeshCoordinates Of(Mesh mesh)
        {
            if (!Known.TryGetValue(mesh, out MeshCoordinates known))
            {
                known = new MeshCoordinates(mesh);
                Known.Set(mesh, known);
            }
            return known;
        }

        public int Triangles => triangles.Length / 3;

        /// <summary>The coordinates of a place, as those of its triangle. False where the triangle has none.</summary>
        /// <param name="scale">The collider's.</param>
        public bool TryFind(in TouchedPlace place, Double3 scale, out MapPlace found)
        {
            found = default;
            if (!TryMeasure(place.Triangle, scale, out Double3 columns, out Double3 rows, out _))
            {
                return false;
            }
            Vector2 start = coordinates[triangles[3 * place.Triangle]];
            Double3 moved = place.LocalMetres - Corner(3 * place.Triangle, scale);
            found = new MapPlace(start.x + Double3.Dot(columns, moved), start.y + Double3.Dot(rows, moved));
            return true;
        }

        /// <summary>The gradients of the coordinates in a triangle, for each metre, and its area. False for a mesh
        /// without coordinates, and for a triangle without area.</summary>
        public bool TryMeasure(
            int triangle, Double3 scale, out Double3 columns, out Double3 rows, out double squareMetres)
        {
            (columns, rows, squareMetres) = (default, default, 0.0);
            int first = 3 * triangle;
            if (first < 0 || first + 2 >= triangles.Length || coordinates.Length != vertices.Length)
            {
                return false;
            }
            Double3 corner = Corner(first, scale);
            Double3 along = Corner(first + 1, scale) - corner;
            Double3 across = Corner(first + 2, scale) - corner;
            double mixed = Double3.Dot(along, across);
            double area = Double3.Dot(along, along) * Double3.Dot(across, across) - mixed * mixed;
            if (!(area > 0.0))
            {
                return false;
            }
            // The vectors in the triangle's plane whose products with one edge are 1 and with the other 0.
            Double3 ofAlong = (along * Double3.Dot(across, across) - across * mixed) / area;
            Double3 ofAcross = (across * Double3.Dot(along, along) - along * mixed) / area;
            Vector2 start = coordinates[triangles[first]];
            Vector2 atAlong = coordinates[triangles[first + 1]] - start;
            Vector2 atAcross = coordinates[triangles[first + 2]] - start;
            columns = ofAlong * atAlong.x + ofAcross * atAcross.x;
            rows = ofAlong * atAlong.y + ofAcross * atAcross.y;
            squareMetres = 0.5 * Math.Sqrt(area);
            return true;
        }

        private Double3 Corner(int index, Double3 scale) =>
            Double3.Scale(vertices[triangles[index]].ToDouble(), scale);

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => Known.Begin();
    }
}
