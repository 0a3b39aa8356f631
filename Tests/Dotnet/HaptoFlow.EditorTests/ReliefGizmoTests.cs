using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>The profile of a relief in the scene view.</summary>
    public sealed class ReliefGizmoTests : PlayedTest
    {
        [SetUp]
        [TearDown]
        public void ClearLines()
        {
            Gizmos.Lines.Clear();
            Handles.Labels.Clear();
            Selection.activeObject = null;
        }

        [Test]
        public void ASelectedBoxHasItsProfileAlongTheGrainThroughTheMiddleOfItsWidestSide()
        {
            HapticSurface table = Table();
            table.transform.position = new Vector3(2f, 0f, 0f);
            table.transform.localScale = new Vector3(2f, 1f, 1f);
            Vector3[] line = Profile(table);
            Assert.That(line.Select(point => point.z), Is.All.EqualTo(0f).Within(1e-5));
            // The map is 0.2 m long, so that two lengths of it are drawn of the table's two metres.
            ExpectRange(line, 1.8f, 2.2f);
            foreach (Vector3 point in line)
            {
                Assert.That(point.y, Is.EqualTo(Expected(0.5 + (point.x - 2f) / 0.2)).Within(2e-5), $"{point.x}");
            }
            Assert.That(Handles.Labels, Is.EqualTo(new[] { "Waves, heights x 5" }));
        }

        [Test]
        public void TheGrainTurnsTheProfile()
        {
            HapticSurface table = Table();
            table.Grain = Vector3.forward;
            Vector3[] line = Profile(table);
            Assert.That(line.Select(point => point.x), Is.All.EqualTo(0f).Within(1e-5));
            Assert.That(line.Max(point => point.z), Is.EqualTo(0.2f).Within(0.003));
        }

        [Test]
        public void AMeshHasItsProfileOverItsTextureWhicheverSideLooksUp([Values] bool isUpsideDown)
        {
            HapticSurface sheet = Tagged("Sheet", "wood");
            Object.DestroyImmediate(sheet.GetComponent<BoxCollider>());
            sheet.gameObject.AddComponent<MeshCollider>().sharedMesh =
                ReliefMeshes.Plane(2, 2, 0.2f, 0.1f, (_, __) => 0f);
            sheet.transform.rotation = Quaternion.AngleAxis(isUpsideDown ? 180f : 0f, Vector3.right);
            sheet.Relief = Waves();
            Physics.SyncTransforms();
            Vector3[] line = Profile(sheet);
            float up = isUpsideDown ? -1f : 1f;
            foreach (Vector3 point in line)
            {
                Assert.That(up * point.y, Is.EqualTo(Expected(point.x / 0.2)).Within(2e-5), $"{point.x}");
            }
        }

        [Test]
        public void ATerrainHasItsProfileAboveTheGround()
        {
            HapticSurface ground = Tagged("Ground", "stone");
            Object.DestroyImmediate(ground.GetComponent<BoxCollider>());
            var data = new TerrainData { heightmapResolution = 5, size = new Vector3(4f, 1f, 4f) };
            var heights = new float[5, 5];
            for (int index = 0; index < 25; ++index)
            {
                heights[index / 5, index % 5] = 0.25f;
            }
            data.SetHeights(0, 0, heights);
            ground.gameObject.AddComponent<TerrainCollider>().terrainData = data;
            ground.Relief = Waves();
            Physics.SyncTransforms();
            Vector3[] line = Profile(ground);
            ExpectRange(line, 1.8f, 2.2f);
            foreach (Vector3 point in line)
            {
                Assert.That(point.y, Is.EqualTo(0.25 + Expected(point.x / 0.2)).Within(1e-4), $"{point.x}");
            }
        }

        [TestCase("no relief")]
        [TestCase("no heights")]
        [TestCase("a sphere")]
        [TestCase("a disabled surface")]
        [TestCase("a box without size")]
        [TestCase("a scale of 0")]
        public void NothingIsDrawnWhereNothingIsFelt(string why)
        {
            HapticSurface table = Table();
            switch (why)
            {
                case "no relief":
                    table.Relief = null;
                    break;
                case "no heights":
                    table.Relief = ScriptableObject.CreateInstance<HapticRelief>();
                    break;
                case "a sphere":
                    Object.DestroyImmediate(table.GetComponent<BoxCollider>());
                    table.gameObject.AddComponent<SphereCollider>();
                    break;
                case "a disabled surface":
                    table.enabled = false;
                    break;
                case "a box without size":
                    table.GetComponent<BoxCollider>().size = Vector3.zero;
                    break;
                default:
                    table.transform.localScale = Vector3.zero;
                    break;
            }
            ReliefGizmos.Draw(table, GizmoType.Selected);
            Assert.That(Gizmos.Lines.Where(line => line.From != line.To), Is.Empty);
        }

        [TestCase(0.0001, 100.0)]
        [TestCase(0.001, 10.0)]
        [TestCase(0.002, 5.0)]
        [TestCase(0.003, 2.0)]
        [TestCase(0.02, 1.0)]
        public void AShallowReliefIsDrawnHigherByARoundFactor(double depthMetres, double factor) =>
            Assert.That(ReliefGizmos.FactorOf(depthMetres), Is.EqualTo(factor));

        [Test]
        public void WhereATipHasBeenTheProfileIsDrawnInPlayMode()
        {
            HapticStylus stylus = PlayOver(Table());
            Gizmos.Lines.Clear();
            ReliefGizmos.Draw(stylus, true);
            Vector3[] line = Lifted();
            // 3 cm at 0.15 m/s; each frame adds 1.7 mm.
            Assert.That(line.Max(point => point.x) - line.Min(point => point.x), Is.EqualTo(0.03f).Within(0.002));
            Assert.That(line.Max(point => point.x), Is.EqualTo(stylus.Contact.Point.x).Within(1e-5));
            foreach (Vector3 point in line)
            {
                Assert.That(point.y, Is.EqualTo(Expected(0.5 + point.x / 0.2)).Within(5e-5), $"{point.x}");
            }
            Assert.That(Handles.Labels, Has.Member("Waves, heights x 5"));
            int drawn = Gizmos.Lines.Count;
            Gizmos.Lines.Clear();
            ReliefGizmos.Draw(stylus, true);
            Assert.That(Gizmos.Lines, Has.Count.EqualTo(drawn), "a second view in the same frame");
            EditorSession.Stop();
        }

        [Test]
        public void OnlyASelectedStylusOrSurfaceIsDrawnInPlayMode()
        {
            HapticSurface table = Table();
            HapticStylus stylus = PlayOver(table);
            Gizmos.Lines.Clear();
            StylusGizmos.Draw(stylus, GizmoType.NonSelected);
            int contact = Gizmos.Lines.Count;
            Assert.That(contact, Is.LessThan(20));
            Selection.activeObject = table.gameObject;
            Frames(2, _ => DrawAgain(stylus));
            Assert.That(Gizmos.Lines, Has.Count.GreaterThan(contact + 10));
            ReliefGizmos.Draw(table, GizmoType.Selected);
            int before = Gizmos.Lines.Count;
            ReliefGizmos.Draw(table, GizmoType.Selected);
            Assert.That(Gizmos.Lines, Has.Count.EqualTo(before), "not the resting profile, too");
            stylus.transform.position = Vector3.up;
            World.Frames(3);
            Gizmos.Lines.Clear();
            ReliefGizmos.Draw(stylus, true);
            Assert.That(Gizmos.Lines, Is.Empty, "it touches nothing");
            EditorSession.Stop();
        }

        [Test]
        public void TheStylusesInspectorShowsTheHeightUnderTheTip()
        {
            HapticStylus stylus = PlayOver(Table());
            stylus.TryGetRelief(out HapticRelief relief, out MapPlace place);
            double millimetres = 1000.0 * relief.Heights!.MetresAt(place);
            string value = InspectorTests.Draw(stylus).First(item => item.Label == "Height").Value;
            Assert.That(value, Is.EqualTo(FormattableString.Invariant($"{millimetres:0.00} mm of Waves")));
            stylus.Contact.Surface!.Relief = null;
            World.Frames(2);
            Assert.That(InspectorTests.Draw(stylus).Select(item => item.Label), Has.None.EqualTo("Height"));
            EditorSession.Stop();
        }

        private static void DrawAgain(HapticStylus stylus)
        {
            stylus.transform.position += new Vector3(0.15f / 90f, 0f, 0f);
            Gizmos.Lines.Clear();
            StylusGizmos.Draw(stylus, GizmoType.NonSelected);
        }

        private HapticStylus PlayOver(HapticSurface table)
        {
            Settings().Quality = HapticQuality.Draft;
            Make("Listener").AddComponent<AudioListener>();
            Output();
            HapticStylus stylus = Stylus();
            stylus.transform.position = new Vector3(-0.2f, 0.001f, 0f);
            EditorSession.Play();
            HapticSession.Current.FinishLoading();
            Frames(45, _ =>
            {
                stylus.transform.position += new Vector3(0.15f / 90f, 0f, 0f);
                ReliefGizmos.Draw(stylus, true);
            });
            World.Frames(1);
            Assert.That(stylus.TryGetRelief(out HapticRelief relief, out _), Is.True);
            Assert.That(relief, Is.SameAs(table.Relief));
            return stylus;
        }

        /// <summary>The places of the drawn line.</summary>
        private static Vector3[] Profile(HapticSurface surface)
        {
            ReliefGizmos.Draw(surface, GizmoType.Selected);
            Vector3[] line = Lifted();
            Assert.That(line, Has.Length.GreaterThan(100));
            return line;
        }

        private static Vector3[] Lifted() => Gizmos.Lines.Where(line => line.Color.a == 1f)
            .Select(line => line.To).ToArray();

        /// <summary>How high the line is at a place of the map: 2 mm deep, drawn 5 times as high.</summary>
        private static double Expected(double place)
        {
            double texel = 64.0 * (place - Math.Floor(place)) - 0.5;
            double whole = Math.Floor(texel);
            double from = Share((int)whole & 63);
            return 0.01 * (from + (texel - whole) * (Share((int)(whole + 1.0) & 63) - from));
        }

        private static double Share(int column) => 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * column / 32.0);

        private static HapticRelief Waves()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Waves";
            (relief.SizeMetres, relief.DepthMillimetres) = (new Vector2(0.2f, 0.2f), 2f);
            relief.SetHeights(64, 1, Enumerable.Range(0, 64).Select(column => (float)Share(column)).ToArray());
            return relief;
        }

        /// <summary>A table of a metre, whose top is at y = 0.</summary>
        private HapticSurface Table()
        {
            HapticSurface table = Tagged("Table", "wood");
            var box = table.GetComponent<BoxCollider>();
            (box.size, box.center) = (new Vector3(1f, 0.1f, 1f), new Vector3(0f, -0.05f, 0f));
            table.Relief = Waves();
            return table;
        }

        private static void ExpectRange(Vector3[] line, float low, float high)
        {
            Assert.That(line.Min(point => point.x), Is.EqualTo(low).Within(0.004));
            Assert.That(line.Max(point => point.x), Is.EqualTo(high).Within(0.004));
        }
    }

    /// <summary>Meshes that are sculpted by functions.</summary>
    internal static class ReliefMeshes
    {
        /// <summary>A grid in the x-z plane from the origin on, seen from above, whose texture coordinates are 0 to 1
        /// along x and z.</summary>
        public static Mesh Plane(int columns, int rows, float width, float length, Func<double, double, float> height)
        {
            var vertices = new List<Vector3>();
            var coordinates = new List<Vector2>();
            var triangles = new List<int>();
            for (int row = 0; row <= rows; ++row)
            {
                for (int column = 0; column <= columns; ++column)
                {
                    (double u, double v) = (column / (double)columns, row / (double)rows);
                    vertices.Add(new Vector3((float)(width * u), height(u, v), (float)(length * v)));
                    coordinates.Add(new Vector2((float)u, (float)v));
                    if (row < rows && column < columns)
                    {
                        int corner = row * (columns + 1) + column;
                        int above = corner + columns + 1;
                        triangles.AddRange(new[] { corner, above, above + 1, corner, above + 1, corner + 1 });
                    }
                }
            }
            return new Mesh
            {
                vertices = vertices.ToArray(), uv = coordinates.ToArray(), triangles = triangles.ToArray(),
            };
        }
    }
}
