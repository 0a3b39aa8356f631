using System;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>Reliefs that are taken from sculpted meshes.</summary>
    public sealed class MeshReliefTests : EditorTest
    {
        private const double Amplitude = 0.001;
        private static readonly Vector3 One = new Vector3(1f, 1f, 1f);

        [Test]
        public void ASculptedPlaneGivesItsHeights()
        {
            HapticRelief relief = Taken(Sine(), One);
            Assert.That(relief.DepthMillimetres, Is.EqualTo(2f).Within(0.03f));
            Assert.That(relief.SizeMetres.x, Is.EqualTo(0.2f).Within(1e-5));
            Assert.That(relief.SizeMetres.y, Is.EqualTo(0.1f).Within(1e-5));
            Assert.That((relief.Columns, relief.Rows), Is.EqualTo((128, 64)), "two texels for an edge");
            Assert.That((relief.Tiling, relief.Offset), Is.EqualTo((new Vector2(1f, 1f), Vector2.zero)));
            Expect(relief, SineAt, 0.02);
        }

        [Test]
        public void TurnedMovedAndScaledItGivesTheSameMap()
        {
            Quaternion turn = Quaternion.AngleAxis(37f, new Vector3(1f, 2f, -0.5f).normalized);
            Mesh mesh = Changed(Sine(), place => turn * place + new Vector3(3f, -2f, 5f));
            Expect(Taken(mesh, One), SineAt, 0.02);
            HapticRelief scaled = Taken(mesh, new Vector3(2f, 2f, 2f));
            Assert.That(scaled.DepthMillimetres, Is.EqualTo(4f).Within(0.06f));
            Assert.That(scaled.SizeMetres.x, Is.EqualTo(0.4f).Within(1e-4));
            Expect(scaled, SineAt, 0.02);
        }

        [Test]
        public void AScaleAlongTheNormalIsThatOfTheDepth()
        {
            HapticRelief relief = Taken(Sine(), new Vector3(1f, 3f, 2f));
            Assert.That(relief.DepthMillimetres, Is.EqualTo(6f).Within(0.09f));
            Assert.That(relief.SizeMetres.y, Is.EqualTo(0.2f).Within(1e-5));
        }

        [TestCase(-1f, 1f, 1f)]
        [TestCase(1f, -1f, 1f)]
        [TestCase(-1f, -1f, -1f)]
        public void AMirroredObjectsHeightsRiseOutOfItsFrontToo(float x, float y, float z) =>
            Expect(Taken(Sine(), new Vector3(x, y, z)), SineAt, 0.02);

        [Test]
        public void MirroredCoordinatesMirrorTheMapAndNotItsHeights()
        {
            Mesh mesh = Sine();
            mesh.uv = Array.ConvertAll(mesh.uv, each => new Vector2(1f - each.x, each.y));
            HapticRelief relief = Taken(mesh, One);
            Expect(relief, (u, v) => SineAt(1.0 - u, v), 0.02);
        }

        [Test]
        public void ABackSideGivesTheHeightsOfItsFront()
        {
            Mesh mesh = Sine();
            mesh.triangles = mesh.triangles.Reverse().ToArray();
            Expect(Taken(mesh, One), (u, v) => 1.0 - SineAt(u, v), 0.02);
        }

        [Test]
        public void AMapLiesOverThePartOfTheTextureThatTheMeshCovers()
        {
            Mesh mesh = Sine();
            mesh.uv = Array.ConvertAll(mesh.uv, each => new Vector2(3f + 0.5f * each.x, -1f + 0.25f * each.y));
            HapticRelief relief = Taken(mesh, One);
            Assert.That((relief.Tiling.x, relief.Tiling.y), Is.EqualTo((2f, 4f)));
            Assert.That((relief.Offset.x, relief.Offset.y), Is.EqualTo((-6f, 4f)));
            Assert.That(relief.SizeMetres.x, Is.EqualTo(0.2f).Within(1e-5));
            Expect(relief, SineAt, 0.02);
        }

        [Test]
        public void HolesHaveTheHeightsOfTheirRimsAndAreMentioned()
        {
            Mesh mesh = Sine();
            int[] triangles = mesh.triangles;
            bool IsHole(int first)
            {
                Vector2 corner = mesh.uv[triangles[first]];
                return corner.x >= 0.4f && corner.x < 0.6f && corner.y >= 0.25f && corner.y < 0.75f;
            }
            mesh.triangles = Enumerable.Range(0, triangles.Length / 3).Where(index => !IsHole(3 * index))
                .SelectMany(index => triangles.Skip(3 * index).Take(3)).ToArray();
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            Assert.That(MeshRelief.Take(relief, mesh, One),
                Is.EqualTo("Sculpture has no surface on 9 % of its map: there the heights of the rims go on.")
                .Or.EqualTo("Sculpture has no surface on 10 % of its map: there the heights of the rims go on."));
            Expect(relief, SineAt, 0.02, (u, v) => Math.Abs(u - 0.5) > 0.12 || Math.Abs(v - 0.5) > 0.27);
            for (int column = 0; column < relief.Columns; ++column)
            {
                Assert.That(relief.HeightAt(column, relief.Rows / 2), Is.InRange(0f, 1f));
                float step = column == 0 ? 0f
                    : relief.HeightAt(column, relief.Rows / 2) - relief.HeightAt(column - 1, relief.Rows / 2);
                Assert.That(Math.Abs(step), Is.LessThan(0.25f), $"no cliff at {column}");
            }
        }

        [TestCase("unreadable", "because it is not readable: switch on Read/Write in the model's import settings.")]
        [TestCase("without coordinates", "because it has no texture coordinates.")]
        [TestCase("without vertices", "because it has no texture coordinates.")]
        [TestCase("with one coordinate", "because its texture coordinates do not lay it out as a surface.")]
        [TestCase("with coordinates on a line", "because its texture coordinates do not lay it out as a surface.")]
        [TestCase("without triangles", "because its texture coordinates do not lay it out as a surface.")]
        [TestCase("with a vertex that is no number", "because a vertex of it is nowhere.")]
        [TestCase("with a coordinate that is no number", "because a vertex of it is nowhere.")]
        [TestCase("even", "because it is flat.")]
        [TestCase("deep", "because its heights span 39 mm, and a relief has 20 at most.")]
        [TestCase("overlapping", "because its texture coordinates overlap on 100 % of it, where the map has but one " +
            "height.")]
        [TestCase("a cylinder", "because it is curved: it bows by 23 % of its size, and a flat piece by 5 % at most.")]
        [TestCase("uneven", "because its texture does not lie evenly on it: it is off by 24 % of its size, and a " +
            "flat piece by 5 % at most.")]
        public void WhatIsNoFlatSculptureIsRefusedWithItsFigure(string kind, string reason)
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.SetHeights(1, 1, new[] { 0.5f });
            string? said = MeshRelief.Take(relief, Odd(kind), One);
            Assert.That(said, Is.EqualTo("The mesh Sculpture was not baked, " + reason));
            Assert.That(relief.HeightAt(0, 0), Is.EqualTo(0.5f).Within(1e-4), "what was there stays");
        }

        [Test]
        public void AScaleOf0IsRefused()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            foreach (float scale in new[] { 0f, float.NaN })
            {
                Assert.That(MeshRelief.Take(relief, Sine(), new Vector3(1f, scale, 1f)),
                    Does.EndWith("a scale of 0 or none."));
            }
        }

        [Test]
        public void ADroppedMeshIsTakenAtTheScaleOfTheObjectWithUndo()
        {
            HapticSurface panel = Make("Panel").AddComponent<HapticSurface>();
            panel.gameObject.AddComponent<BoxCollider>();
            panel.transform.localScale = new Vector3(2f, 2f, 2f);
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            panel.Relief = relief;
            UnityEditor.Editor inspector = UnityEditor.Editor.CreateEditor(new UnityEngine.Object[] { relief });
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Undo.IncrementCurrentGroup();
            EditorScreen.Enter("Take from a Mesh", Sine());
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Assert.That(relief.SizeMetres.x, Is.EqualTo(0.4f).Within(1e-4));
            Assert.That(relief.DepthMillimetres, Is.EqualTo(4f).Within(0.06f));
            Undo.PerformUndo();
            Assert.That(relief.IsBaked, Is.False);
            EditorScreen.Enter("Take from a Mesh", Odd("even"));
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Assert.That(EditorScreen.Draw(inspector.OnInspectorGUI).Select(item => item.Label),
                Has.Member("The mesh Sculpture was not baked, because it is flat."));
        }

        [Test]
        public void ALargeSculptureHasTheMostTexelsAndNeedsNoLongWait()
        {
            Mesh mesh = ReliefMeshes.Plane(600, 600, 0.5f, 0.5f, (u, v) => (float)(Amplitude * Math.Sin(60.0 * u)));
            var watch = System.Diagnostics.Stopwatch.StartNew();
            HapticRelief relief = Taken(mesh, One);
            TestContext.WriteLine($"{mesh.triangles.Length / 3} triangles: {watch.ElapsedMilliseconds} ms");
            Assert.That((relief.Columns, relief.Rows), Is.EqualTo((1024, 1024)), "the most texels");
            Assert.That(watch.ElapsedMilliseconds, Is.LessThan(20000));
        }

        private HapticRelief Taken(Mesh mesh, Vector3 scale)
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            Assert.That(MeshRelief.Take(relief, mesh, scale), Is.Null);
            return relief;
        }

        /// <summary>Waves along the columns, three of them, and a slower rise along the rows.</summary>
        private static double SineAt(double u, double v) =>
            0.5 + 0.5 * Math.Sin(6.0 * Math.PI * u) * Math.Cos(2.0 * Math.PI * v);

        private static Mesh Sine() => Named(ReliefMeshes.Plane(
            64, 32, 0.2f, 0.1f, (u, v) => (float)(2.0 * Amplitude * SineAt(u, v))));

        private static Mesh Named(Mesh mesh)
        {
            mesh.name = "Sculpture";
            return mesh;
        }

        private static Mesh Changed(Mesh mesh, Func<Vector3, Vector3> change)
        {
            mesh.vertices = Array.ConvertAll(mesh.vertices, place => change(place));
            return mesh;
        }

        private static Mesh Odd(string kind)
        {
            Mesh mesh = Sine();
            switch (kind)
            {
                case "unreadable":
                    mesh.UploadMeshData(true);
                    break;
                case "without coordinates":
                    mesh.uv = Array.Empty<Vector2>();
                    break;
                case "without vertices":
                    return Named(new Mesh());
                case "with one coordinate":
                    mesh.uv = new Vector2[mesh.vertices.Length];
                    break;
                case "with coordinates on a line":
                    mesh.uv = Array.ConvertAll(mesh.uv, each => new Vector2(each.x, 2f * each.x));
                    break;
                case "without triangles":
                    mesh.triangles = Array.Empty<int>();
                    break;
                case "with a vertex that is no number":
                    mesh.vertices = mesh.vertices.Skip(1).Append(new Vector3(float.NaN, 0f, 0f)).ToArray();
                    break;
                case "with a coordinate that is no number":
                    mesh.uv = mesh.uv.Skip(1).Append(new Vector2(0f, float.PositiveInfinity)).ToArray();
                    break;
                case "even":
                    return Changed(mesh, place => new Vector3(place.x, 0.2f * place.x, place.z));
                case "deep":
                    return Changed(mesh, place => new Vector3(place.x, 20f * place.y, place.z));
                case "overlapping":
                    mesh.uv = Array.ConvertAll(mesh.uv, each => new Vector2(0.5f - Math.Abs(each.x - 0.5f), each.y));
                    mesh.vertices = Array.ConvertAll(mesh.vertices,
                        place => new Vector3(0.1f - Math.Abs(place.x - 0.1f), place.y, place.z));
                    break;
                case "a cylinder":
                    return Changed(mesh, place => 0.1f * new Vector3(
                        (float)Math.Sin(place.x / 0.1), (float)Math.Cos(place.x / 0.1), 10f * place.z));
                default:
                    mesh.uv = Array.ConvertAll(mesh.uv, each => new Vector2(each.x * each.x * each.x, each.y));
                    break;
            }
            return mesh;
        }

        private static void Expect(HapticRelief relief, Func<double, double, double> share, double slack,
            Func<double, double, bool>? counts = null)
        {
            double worst = 0.0;
            for (int texel = 0; texel < relief.Columns * relief.Rows; ++texel)
            {
                (int column, int row) = (texel % relief.Columns, texel / relief.Columns);
                (double u, double v) = ((column + 0.5) / relief.Columns, (row + 0.5) / relief.Rows);
                if (counts == null || counts(u, v))
                {
                    worst = Math.Max(worst, Math.Abs(relief.HeightAt(column, row) - share(u, v)));
                }
            }
            TestContext.WriteLine(FormattableString.Invariant($"{100.0 * worst:0.00} % of the depth"));
            Assert.That(worst, Is.LessThan(slack));
        }
    }

    /// <summary>Reliefs that are taken from the normal map of a terrain's layer.</summary>
    public sealed class TerrainReliefTests : EditorTest
    {
        [Test]
        public void ALayerGivesTheHeightsOfItsNormalMapWhereItsTextureIsSeen()
        {
            TerrainLayer layer = Layer("Sand");
            layer.tileOffset = new Vector2(0.5f, 3f);
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.Tiling = new Vector2(3f, 3f);
            Assert.That(TerrainRelief.Take(relief, layer), Is.Null);
            Assert.That(relief.SizeMetres, Is.EqualTo(new Vector2(2f, 4f)), "the tile size");
            Assert.That((relief.Offset.x, relief.Offset.y), Is.EqualTo((0.25f, 0.75f)), "in lengths of the map");
            Assert.That((relief.Tiling, relief.Repeats), Is.EqualTo((new Vector2(1f, 1f), true)));
            Assert.That(relief.DepthMillimetres, Is.EqualTo(4f).Within(0.1f));
            ReliefBakeTests.ExpectSine(relief);
            layer.normalScale = 0.5f;
            TerrainRelief.Take(relief, layer);
            Assert.That(relief.DepthMillimetres, Is.EqualTo(2f).Within(0.05f));
        }

        [TestCase("no map", "The layer Sand has no normal map: it has no heights.")]
        [TestCase("no size", "The layer Sand has a tile size of 0 x 4 m. Give it a size above 0.")]
        [TestCase("a scale of 0", "The map Dunes of Sand is even: it has no heights.")]
        [TestCase("a size that is no number", "The layer Sand has a tile size of NaN x 4 m. Give it a size above 0.")]
        public void WhatALayerLacksIsSaidAndChangesNothing(string what, string said)
        {
            TerrainLayer layer = Layer("Sand");
            layer.normalMapTexture = what == "no map" ? null : layer.normalMapTexture;
            layer.tileSize = new Vector2(
                what == "no size" ? 0f : what == "a size that is no number" ? float.NaN : 2f, 4f);
            layer.normalScale = what == "a scale of 0" ? 0f : 1f;
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            Assert.That(TerrainRelief.Take(relief, layer), Is.EqualTo(said));
            Assert.That(relief.IsBaked, Is.False);
        }

        [Test]
        public void ASurfaceOnATerrainTakesTheLayerThatCoversMostOfItWithUndo()
        {
            TerrainLayer[] layers = { Layer("Grass"), Layer("Sand") };
            layers[1].tileSize = new Vector2(1f, 1f);
            AssetDatabase.CreateAsset(layers[1], Folder + "/Sand.terrainlayer");
            HapticSurface ground = Ground(layers, out TerrainData data);
            EditorScreen.Press("Take from the Terrain's Layer");
            Assert.That(InspectorTests.Draw(ground).Select(item => item.Label),
                Has.None.EqualTo("Take from the Object's Material"));
            Assert.That(ground.Relief!.SizeMetres.x, Is.EqualTo(2f), "the first layer covers a new terrain");
            Undo.PerformUndo();
            Assert.That(ground.Relief == null, Is.True);
            var weights = new float[16, 16, 2];
            for (int place = 0; place < 256; ++place)
            {
                weights[place / 16, place % 16, place % 16 < 6 ? 0 : 1] = 1f;
            }
            data.SetAlphamaps(0, 0, weights);
            Assert.That(TerrainRelief.Take(ground, ground.GetComponent<TerrainCollider>()), Is.Null);
            Assert.That(ground.Relief!.SizeMetres.x, Is.EqualTo(1f));
            Assert.That(AssetDatabase.GetAssetPath(ground.Relief), Is.EqualTo(Folder + "/Sand Relief.asset"));
        }

        [Test]
        public void ATerrainWithoutLayersSaysSo()
        {
            HapticSurface ground = Ground(Array.Empty<TerrainLayer>(), out _);
            EditorScreen.Press("Take from the Terrain's Layer");
            UnityEditor.Editor inspector = UnityEditor.Editor.CreateEditor(new Object[] { ground });
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Assert.That(EditorScreen.Draw(inspector.OnInspectorGUI).Select(item => item.Label),
                Has.Member("Ground has no terrain layer. Paint one with a normal map."));
        }

        [Test]
        public void ADroppedLayerIsTaken()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            EditorScreen.Enter("Take from a Layer", Layer("Sand"));
            InspectorTests.Draw(relief);
            Assert.That(relief.SizeMetres.y, Is.EqualTo(4f));
        }

        /// <summary>A layer of 2 x 4 m with one wave of 2 mm along it.</summary>
        internal static TerrainLayer Layer(string name)
        {
            Texture2D map = ReliefBakeTests.Normals(64, 0.002, false, 2.0);
            map.name = "Dunes";
            return new TerrainLayer { name = name, normalMapTexture = map, tileSize = new Vector2(2f, 4f) };
        }

        private HapticSurface Ground(TerrainLayer[] layers, out TerrainData data)
        {
            data = new TerrainData { terrainLayers = layers };
            HapticSurface ground = Make("Ground").AddComponent<HapticSurface>();
            ground.gameObject.AddComponent<TerrainCollider>().terrainData = data;
            return ground;
        }
    }

    /// <summary>What Check Scene says about reliefs of terrain layers.</summary>
    public sealed class TerrainReliefCheckTests : SceneCheckTest
    {
        [Test]
        public void AReliefThatDoesNotLieAsItsLayerDoesIsMentioned()
        {
            TerrainLayer layer = TerrainReliefTests.Layer("Sand");
            layer.tileSize = new Vector2(0.2f, 0.2f);
            layer.tileOffset = new Vector2(0.1f, 0f);
            HapticMaterialMap map = CreateMap();
            map.Add(HapticMaterialRule.ForTerrainLayer(layer, Feeling("stone")));
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Dunes";
            map.Rules[0].Relief = relief;
            ProjectSettings.MaterialMap = map;
            TerrainData data = new TerrainData { terrainLayers = new[] { layer } };
            Make("Ground").AddComponent<TerrainCollider>().terrainData = data;
            TerrainRelief.Take(relief, layer);
            Assert.That(Texts(), Has.None.Contains("does not lie"));
            relief.Offset += new Vector2(1f, 0f);
            Assert.That(Texts(), Has.None.Contains("does not lie"), "a whole map aside");
            layer.tileOffset = new Vector2(0.05f, 0f);
            Assert.That(Texts(), Has.One.Contains("The relief Dunes does not lie where the texture of the terrain " +
                "layer Sand is seen"));
            TerrainRelief.Take(relief, layer);
            layer.tileSize = new Vector2(0.2f, 0.3f);
            Assert.That(Texts(), Has.One.Contains("Dunes does not lie"));
        }
    }
}
