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
    /// <summary>Reliefs that are baked from the maps of an object's material.</summary>
    public sealed class ReliefBakeTests : EditorTest
    {
        private const string Button = ReliefButton.Caption;

        private Material paint = null!;

        [SetUp]
        public void MixPaint()
        {
            paint = new Material(SimulatedPipeline.ShaderNamed("Standard"));
            AssetDatabase.CreateAsset(paint, Folder + "/Bricks.asset");
        }

        [Test]
        public void AHeightMapBecomesAReliefBesideTheMaterial()
        {
            HapticSurface wall = Wall();
            paint.SetTexture("_ParallaxMap", Grey(3, 2, 0f, 0.25f, 0.5f, 1f, 0.75f, 0.125f));
            paint.SetFloat("_Parallax", 0.05f);
            Tile("_MainTex", 2f, 4f);
            EditorScreen.Press(Button);
            InspectorTests.Draw(wall);
            HapticRelief relief = wall.Relief!;
            Assert.That(AssetDatabase.GetAssetPath(relief), Is.EqualTo(Folder + "/Bricks Relief.asset"));
            Expect(relief, 3, 2, 0f, 0.25f, 0.5f, 1f, 0.75f, 0.125f);
            Assert.That(relief.SizeMetres, Is.EqualTo(new Vector2(0.2f, 0.05f)), "0.4 x 0.2 m, twice and four times");
            Assert.That(relief.DepthMillimetres, Is.EqualTo(1000f * 0.05f * 0.2f).Within(1e-3f));
            Assert.That((relief.Tiling, relief.Offset), Is.EqualTo((new Vector2(2f, 4f), new Vector2(0.25f, 0.5f))));
            Assert.That(relief.Repeats, Is.True);
        }

        [TestCase("_HeightMap", "_BaseColorMap", "_HeightAmplitude", 0.003f, 3f)]
        [TestCase("_ParallaxMap", "_BaseMap", "_Parallax", 0.01f, 4f)]
        [TestCase("_ParallaxMap", "_BaseMap", "_Other", 0.01f, 1f)]
        public void TheDepthIsThatOfTheMaterialsParallax(
            string map, string colour, string property, float value, float millimetres)
        {
            HapticSurface wall = Wall();
            paint.SetTexture(map, Grey(2, 1, 0f, 1f));
            paint.SetFloat(property, value);
            Tile(colour, 1f, 1f);
            Assert.That(ReliefBake.Take(wall), Is.Null);
            Assert.That(wall.Relief!.DepthMillimetres, Is.EqualTo(millimetres).Within(1e-3f));
        }

        [Test]
        public void AHeightMapIsTakenBeforeANormalMapAndTheShadersChannelBeforeOthers()
        {
            HapticSurface wall = Wall();
            paint.SetTexture("_BumpMap", Normals(8, 0.001, false));
            var map = new Texture2D(2, 1, TextureFormat.RGBA32, false);
            map.SetPixels(new[] { new Color(0f, 0.25f, 0f), new Color(1f, 0.5f, 0f) });
            paint.SetTexture("_ParallaxMap", map);
            ReliefBake.Take(wall);
            Expect(wall.Relief!, 2, 1, 0.25f, 0.5f);
            map.SetPixels(new[] { new Color(0f, 0f, 0f), new Color(1f, 0f, 0f) });
            ReliefBake.Take(wall);
            Expect(wall.Relief!, 2, 1, 0f, 1f);
        }

        [Test]
        public void ANormalMapBecomesTheHeightsWhoseSlopesItShows([Values] bool isCompressed)
        {
            HapticSurface wall = Wall();
            paint.SetTexture("_NormalMap", Normals(64, 0.001, isCompressed));
            Assert.That(ReliefBake.Take(wall), Is.Null);
            HapticRelief relief = wall.Relief!;
            Assert.That(relief.DepthMillimetres, Is.EqualTo(2f).Within(0.05f));
            ExpectSine(relief);
        }

        [Test]
        public void TheMaterialsScaleOfNormalsIsThatOfTheHeights()
        {
            HapticSurface wall = Wall();
            paint.SetTexture("_BumpMap", Normals(64, 0.001, false));
            paint.SetFloat("_BumpScale", 0.5f);
            ReliefBake.Take(wall);
            Assert.That(wall.Relief!.DepthMillimetres, Is.EqualTo(1f).Within(0.03f));
        }

        [Test]
        public void ATextureThatScriptsCannotReadIsBakedToo()
        {
            HapticSurface wall = Wall();
            Texture2D map = Grey(2, 1, 0f, 1f);
            map.Apply(false, true);
            paint.SetTexture("_ParallaxMap", map);
            int before = MediaCount.Alive;
            Assert.That(ReliefBake.Take(wall), Is.Null);
            Expect(wall.Relief!, 2, 1, 0f, 1f);
            Assert.That(MediaCount.Alive, Is.EqualTo(before), "nothing stays in the editor's memory");
        }

        [Test]
        public void AMapWithTooManyTexelsIsHalved()
        {
            HapticSurface wall = Wall();
            var map = new Texture2D(4096, 1024, TextureFormat.RGBA32, false);
            var pixels = new Color[4096 * 1024];
            for (int index = 0; index < pixels.Length; ++index)
            {
                pixels[index] = (index % 4 / 2 + index / 4096 % 4 / 2 == 1 ? 0f : 1f) * Color.white;
            }
            map.SetPixels(pixels);
            paint.SetTexture("_ParallaxMap", map);
            Assert.That(ReliefBake.Take(wall), Is.Null);
            HapticRelief relief = wall.Relief!;
            Assert.That((relief.Columns, relief.Rows), Is.EqualTo((2048, 512)));
            Assert.That((relief.HeightAt(0, 0), relief.HeightAt(1, 0)), Is.EqualTo((1f, 0f)));
            Assert.That((relief.HeightAt(0, 1), relief.HeightAt(1, 1)), Is.EqualTo((0f, 1f)));
        }

        [Test]
        public void OneUndoRemovesANewReliefAndRestoresAnOldOne()
        {
            HapticSurface wall = Wall();
            paint.SetTexture("_ParallaxMap", Grey(2, 1, 0f, 1f));
            ReliefBake.Take(wall);
            HapticRelief relief = wall.Relief!;
            paint.SetTexture("_ParallaxMap", Grey(1, 3, 1f, 0f, 0.5f));
            ReliefBake.Take(wall);
            Assert.That(wall.Relief, Is.SameAs(relief), "what other surfaces share is baked again");
            Expect(relief, 1, 3, 1f, 0f, 0.5f);
            Undo.PerformUndo();
            Expect(relief, 2, 1, 0f, 1f);
            Undo.PerformUndo();
            Assert.That(wall.Relief == null, Is.True);
        }

        [Test]
        public void WhatCannotBeBakedIsSaidWithItsNameAndARemedy()
        {
            HapticSurface wall = Wall();
            Assert.That(ReliefBake.Take(wall),
                Does.StartWith("Wall: its renderer has no material with a height or normal map."));
            paint.SetTexture("_ParallaxMap", Grey(2, 1, 0.5f, 0.5f));
            Assert.That(ReliefBake.Take(wall), Is.EqualTo("The map Relief of Bricks is even: it has no heights."));
            paint.SetTexture("_ParallaxMap", null);
            var flat = new Texture2D(2, 1, TextureFormat.RGBA32, false) { name = "Flat" };
            flat.SetPixels(new[] { new Color(0.5f, 0.5f, 1f), new Color(0.5f, 0.5f, 1f) });
            paint.SetTexture("_BumpMap", flat);
            Assert.That(ReliefBake.Take(wall), Does.Contain("Flat of Bricks is even"));
            Assert.That(wall.Relief, Is.Null);
        }

        [Test]
        public void WithoutAReadableMeshTheSizeIsLeftToTheUser()
        {
            HapticSurface wall = Wall();
            wall.GetComponent<MeshFilter>().sharedMesh!.UploadMeshData(true);
            paint.SetTexture("_ParallaxMap", Grey(2, 1, 0f, 1f));
            UnityEditor.Editor inspector = UnityEditor.Editor.CreateEditor(new Object[] { wall });
            EditorScreen.Press(Button);
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Assert.That(wall.Relief!.IsBaked, Is.True);
            Assert.That(wall.Relief.SizeMetres, Is.EqualTo(new Vector2(0.1f, 0.1f)));
            IEnumerable<string> shown = EditorScreen.Draw(inspector.OnInspectorGUI).Select(item => item.Label);
            Assert.That(shown, Has.Some.Contains(
                "Bricks Relief does not know how large its map is, because the mesh of Wall is not readable"));
        }

        [Test]
        public void AReliefShowsItsProfileAndBakesFromASurfaceThatUsesIt()
        {
            HapticRelief relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Waves";
            Assert.That(Labels(relief), Has.Some.StartsWith("Waves has no heights: it is not felt.").And
                .Some.StartsWith("No Haptic Surface of the open scenes uses this relief."));
            HapticSurface wall = Wall();
            wall.Relief = relief;
            paint.SetTexture("_ParallaxMap", Grey(3, 1, 0f, 1f, 0f));
            EditorScreen.Press(Button);
            InspectorTests.Draw(relief);
            Expect(relief, 3, 1, 0f, 1f, 0f);
            Assert.That(Labels(relief),
                Has.Member("Baked: 3 x 1 texels. Their middle row:").And.None.Contains("not felt"));
        }

        [Test]
        public void ASurfaceTakesAReliefInItsInspectorWithUndo()
        {
            HapticSurface wall = Wall();
            HapticRelief relief = ScriptableObject.CreateInstance<HapticRelief>();
            Undo.IncrementCurrentGroup();
            EditorScreen.Enter("Relief", relief);
            IReadOnlyList<Drawn> drawn = InspectorTests.Draw(wall);
            Assert.That(wall.Relief, Is.SameAs(relief));
            Assert.That(drawn.Single(item => item.Label == "Relief").Tooltip, Does.Contain("follows the heights"));
            Undo.PerformUndo();
            Assert.That(wall.Relief == null, Is.True);
        }

        [Test]
        public void TheInspectorOfASurfaceSaysWhyItsReliefCannotBeFelt()
        {
            HapticSurface ball = Make("Ball").AddComponent<HapticSurface>();
            ball.gameObject.AddComponent<SphereCollider>();
            ball.Relief = ScriptableObject.CreateInstance<HapticRelief>();
            ball.Relief.name = "Waves";
            Assert.That(Labels(ball), Has.Some.EndsWith("The relief Waves cannot be felt on Ball, because only " +
                "boxes, terrains and mesh colliders say where in a map they are touched."));
        }

        private static IEnumerable<string> Labels(Object target) =>
            InspectorTests.Draw(target).Select(item => item.Label);

        private static void Expect(HapticRelief relief, int columns, int rows, params float[] heights)
        {
            Assert.That((relief.Columns, relief.Rows), Is.EqualTo((columns, rows)));
            for (int texel = 0; texel < heights.Length; ++texel)
            {
                Assert.That(relief.HeightAt(texel % columns, texel / columns),
                    Is.EqualTo(heights[texel]).Within(1f / 65535f));
            }
        }

        /// <summary>The heights of the map that <see cref="Normals"/> makes with 64 columns.</summary>
        internal static void ExpectSine(HapticRelief relief)
        {
            for (int column = 0; column < 64; ++column)
            {
                Assert.That(relief.HeightAt(column, 1),
                    Is.EqualTo(0.5 + 0.5 * Math.Sin(2.0 * Math.PI * column / 64.0)).Within(0.02), $"column {column}");
            }
        }

        private static Texture2D Grey(int width, int height, params float[] values)
        {
            var map = new Texture2D(width, height, TextureFormat.RGBA32, false) { name = "Relief" };
            map.SetPixels(values.Select(value => new Color(value, value, value)).ToArray());
            return map;
        }

        /// <summary>The normals of one sine along the columns, over the wall's 0.4 m or another length.</summary>
        /// <param name="isCompressed">True for x in alpha and red full, as Unity compresses normal maps.</param>
        internal static Texture2D Normals(int width, double amplitude, bool isCompressed, double metres = 0.4)
        {
            var map = new Texture2D(width, 2, TextureFormat.RGBA32, false) { name = "Normals" };
            map.SetPixels(Enumerable.Range(0, 2 * width).Select(texel =>
            {
                double slope = amplitude * 2.0 * Math.PI / metres * Math.Cos(2.0 * Math.PI * (texel % width) / width);
                float x = (float)(0.5 - 0.5 * slope / Math.Sqrt(1.0 + slope * slope));
                return isCompressed ? new Color(1f, 0.5f, 0.5f, x) : new Color(x, 0.5f, 1f, 1f);
            }).ToArray());
            return map;
        }

        private void Tile(string property, float x, float y)
        {
            paint.SetTextureScale(property, new Vector2(x, y));
            paint.SetTextureOffset(property, new Vector2(0.25f, 0.5f));
        }

        /// <summary>A wall of 0.4 x 0.2 m, whose texture coordinates are 0 to 1.</summary>
        private HapticSurface Wall()
        {
            GameObject wall = Make("Wall");
            wall.transform.localScale = new Vector3(2f, 1f, 1f);
            var mesh = new Mesh
            {
                vertices = new[]
                {
                    Vector3.zero, new Vector3(0f, 0.2f, 0f), new Vector3(0.2f, 0.2f, 0f), new Vector3(0.2f, 0f, 0f),
                },
                uv = new[] { new Vector2(0f, 0f), new Vector2(0f, 1f), new Vector2(1f, 1f), new Vector2(1f, 0f) },
                triangles = new[] { 0, 1, 2, 0, 2, 3 },
            };
            wall.AddComponent<MeshFilter>().sharedMesh = mesh;
            wall.AddComponent<MeshRenderer>().sharedMaterial = paint;
            wall.AddComponent<MeshCollider>().sharedMesh = mesh;
            return wall.AddComponent<HapticSurface>();
        }
    }

    /// <summary>What Check Scene says about reliefs.</summary>
    public sealed class ReliefCheckTests : SceneCheckTest
    {
        [Test]
        public void AReliefThatCanBeFeltIsNoFinding()
        {
            HapticRelief relief = Waves();
            All<HapticSurface>().Single().Relief = relief;
            Assert.That(Texts(), Is.Empty);
            Assert.That(EffectRules.Summary(new SceneContents()), Does.Contain("relief (1 collider)"));
            relief.SizeMetres = new Vector2(0.1f, 2f);
            Only("Waves: a texel is 20 mm long, too coarse");
            relief.SizeMetres = new Vector2(0.1f, 0.4f);
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AReliefWithoutHeightsIsNamed()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Empty";
            All<HapticSurface>().Single().Relief = relief;
            Only("Empty has no heights: it is not felt. Press Take from the Object's Material");
        }

        [Test]
        public void ASceneWhoseOnlyEffectIsAReliefIsFelt()
        {
            HapticSurface table = All<HapticSurface>().Single();
            table.Material.Effects = HapticEffects.Nothing;
            Only("No surface has an effect");
            table.Relief = Waves();
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void EveryReasonWhyAReliefCannotBeFeltIsNamed()
        {
            HapticSurface rug = Make("Rug").AddComponent<HapticSurface>();
            rug.Material.Label = "wood";
            rug.Relief = Waves();
            var collider = rug.gameObject.AddComponent<MeshCollider>();
            var mesh = new Mesh { vertices = new Vector3[3], triangles = new[] { 0, 1, 2 } };
            collider.sharedMesh = mesh;
            With("Rug: the relief Waves cannot be felt, because its mesh has no first texture coordinates");
            mesh.uv = new Vector2[3];
            Assert.That(Texts(), Has.None.Contains("Waves"));
            collider.convex = true;
            With("because a convex mesh collider has no texture coordinates: switch Convex off");
            collider.convex = false;
            mesh.UploadMeshData(true);
            var importer = new ModelImporter();
            AssetDatabase.AddImported(Folder + "/Rug.fbx", mesh, importer);
            Finding unreadable = With("because its mesh is not readable: switch on Read/Write");
            unreadable.Repairs.Single().Act();
            Assert.That(importer.isReadable, Is.True);
            Object.DestroyImmediate(collider);
            rug.gameObject.AddComponent<SphereCollider>();
            With("Rug: the relief Waves cannot be felt, because only boxes, terrains and mesh colliders say where");
        }

        [Test]
        public void AReliefOfARuleIsChecked()
        {
            HapticMaterialMap map = CreateMap();
            map.Add(HapticMaterialRule.ForName("Ball", Feeling("stone")));
            map.Rules[0].Relief = Waves();
            ProjectSettings.MaterialMap = map;
            Make("Ball").AddComponent<SphereCollider>();
            With("Ball: the relief Waves cannot be felt");
            Assert.That(InspectorTests.Draw(map).Select(item => item.Label), Has.Member("Relief"));
        }

        private static Finding With(string part) => Findings().Single(finding => finding.Text.Contains(part));

        private static HapticRelief Waves()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Waves";
            relief.SetHeights(100, 100, new float[100 * 100]);
            return relief;
        }
    }
}
