using System;
using System.Linq;
using HaptoFlow.Contact;
using HaptoFlow.Native;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Where a tip is in the map of a relief, and what is felt of it.</summary>
    public sealed class ReliefTests : SceneTest
    {
        private const float Slack = 2e-3f;

        /// <summary>A sine of 2 mm along the columns, 0.2 mm deep, on a map of 10 x 20 cm.</summary>
        internal static HapticRelief Ribs()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.SizeMetres = new Vector2(0.1f, 0.2f);
            relief.DepthMillimetres = 0.2f;
            relief.SetHeights(800, 1, Enumerable.Range(0, 800)
                .Select(column => 0.5f + 0.5f * (float)Math.Sin(2.0 * Math.PI * column / 16.0)).ToArray());
            return relief;
        }

        /// <summary>A sheet of 20 x 20 cm at y = 0. Its texture is turned: u goes up along z, three times over it, and
        /// v goes down along x.</summary>
        internal static Mesh Sheet() => new Mesh
        {
            vertices = new[]
            {
                new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0.1f, 0f, 0.1f),
                new Vector3(0.1f, 0f, -0.1f),
            },
            uv = new[] { new Vector2(0f, 1f), new Vector2(3f, 1f), new Vector2(3f, 0f), new Vector2(0f, 0f) },
            triangles = new[] { 0, 1, 2, 0, 2, 3 },
        };

        [TestCase(1.0)]
        [TestCase(4.0, Description = "under a scaled rig metres are those of the world")]
        public void OnABoxTheMapIsLaidOutInMetresFromTheMiddleOfTheFace(double rigScale)
        {
            Board().Relief = Keep(Ribs());
            ContactState state = Touch(new Vector3(0.03f, 0.001f, -0.05f), rigScale);
            Expect(state, 0.5f + 0.3f, 0.5f - 0.25f);
            Assert.That(state.ReliefShare, Is.EqualTo(0.5f));
            Assert.That(state.Relief, Is.Not.Zero);
        }

        [Test]
        public void AMapOnABoxIsNoMirrorImageWhereverTheFaceLooks(
            [Values(0, 1, 2)] int axis, [Values(1f, -1f)] float side)
        {
            Vector3 outward = side * (axis == 0 ? Vector3.right : axis == 1 ? Vector3.up : Vector3.forward);
            Tagged<BoxCollider>("wood", box => box.size = 0.2f * Vector3.one).Relief = Keep(Ribs());
            Vector3 columns = Way(outward, place => place.Column);
            Vector3 rows = Way(outward, place => place.Row);
            // In Unity's left-handed space: right x up points away from who looks at the face.
            Assert.That(Vector3.Dot(Vector3.Cross(columns, rows), outward), Is.EqualTo(-10f * 5f).Within(0.1f));
        }

        [Test]
        public void TheMapTurnsWithTheGrainAndWithTheObject()
        {
            HapticSurface board = Board();
            board.Relief = Keep(Ribs());
            board.Grain = new Vector3(0f, 0f, 1f);
            ContactState along = Touch(new Vector3(0.03f, 0.001f, -0.05f));
            Expect(along, 0.5f - 0.5f, 0.5f - 0.15f);
            board.transform.rotation = Quaternion.AngleAxis(90f, Vector3.up);
            board.transform.position = new Vector3(0.1f, 0.2f, 0.3f);
            ContactState turned = Touch(board.transform.position +
                board.transform.rotation * new Vector3(0.03f, 0.001f, -0.05f));
            Expect(turned, along.ReliefPlace.Column, along.ReliefPlace.Row);
        }

        [Test]
        public void OnAScaledBoxMetresAreThoseOfTheWorld()
        {
            HapticSurface board = Board();
            board.Relief = Keep(Ribs());
            board.transform.localScale = new Vector3(2f, 1f, 0.5f);
            Expect(Touch(new Vector3(0.03f, 0.001f, -0.05f)), 0.5f + 0.3f, 0.5f - 0.25f);
        }

        [Test]
        public void OnAMeshTheMapLiesOverItsTextureCoordinates([Values(1f, 2f)] float scale)
        {
            HapticSurface sheet = Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = Sheet());
            sheet.transform.localScale = new Vector3(scale, 1f, 1f);
            sheet.Relief = Keep(Ribs());
            Expect(Touch(new Vector3(0.04f * scale, 0.001f, -0.03f)), 3f * 0.07f / 0.2f, 0.06f / 0.2f);
        }

        [Test]
        public void TheMaterialsTilingAndOffsetAreThoseOfTheMap()
        {
            HapticSurface sheet = Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = Sheet());
            sheet.Relief = Keep(Ribs());
            (sheet.Relief.Tiling, sheet.Relief.Offset) = (new Vector2(2f, 4f), new Vector2(0.25f, 0.125f));
            Expect(Touch(new Vector3(0.04f, 0.001f, -0.03f)),
                2f * 3f * 0.07f / 0.2f + 0.25f, 4f * 0.06f / 0.2f + 0.125f);
        }

        [Test]
        public void TheNextPlaceIsWhereTheStepLeads([Values] bool onMesh)
        {
            HapticSurface floor = onMesh ? Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = Sheet()) : Board();
            floor.Relief = Keep(Ribs());
            ContactState here = Touch(new Vector3(0.03f, 0.001f, -0.05f));
            ContactState there = Touch(new Vector3(0.034f, 0.001f, -0.047f));
            // On the board columns go on along x and rows along z; on the sheet they are turned.
            (float columns, float rows) = onMesh ? (15f * 0.003f, -5f * 0.004f) : (10f * 0.004f, 5f * 0.003f);
            Expect(there, here.ReliefPlace.Column + columns, here.ReliefPlace.Row + rows);
        }

        [Test]
        public void ATerrainHasTheMapInMetresFromItsCorner()
        {
            HapticSurface ground = Tagged<TerrainCollider>("stone",
                terrain => terrain.terrainData = new TerrainData { heightmapResolution = 5 });
            ground.transform.position = new Vector3(-0.5f, 0f, -0.5f);
            ground.Relief = Keep(Ribs());
            Expect(Touch(new Vector3(0.03f, 0.001f, -0.05f)), 5.3f, 2.25f);
            ground.Relief.Offset = new Vector2(0.25f, -0.5f);
            Expect(Touch(new Vector3(0.03f, 0.001f, -0.05f)), 5.55f, 1.75f);
        }

        [Test]
        public void OnATerrainTheReliefIsThatOfTheLayerThatDominatesUnderTheTip()
        {
            TerrainLayer[] layers = { Keep(new TerrainLayer()), Keep(new TerrainLayer()), Keep(new TerrainLayer()) };
            HapticMaterialMap map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[0], Feeling("wood")));
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[1], Feeling("stone")));
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[2], null));
            map.Rules[0].Relief = Keep(Ribs());
            map.Rules[1].Relief = Keep(Ribs());
            map.Rules[2].Relief = Keep(Ribs());
            HaptoFlowSettings.Active.MaterialMap = map;
            TerrainData data = Keep(new TerrainData { heightmapResolution = 5, terrainLayers = layers });
            var weights = new float[16, 16, 3];
            for (int place = 0; place < 256; ++place)
            {
                // From the left: the first layer, more of the first, more of the second, nothing that is felt.
                float first = new[] { 1f, 0.6f, 0.3f, 0f }[place % 16 / 4];
                weights[place / 16, place % 16, 0] = first;
                weights[place / 16, place % 16, 1] = first > 0f ? 1f - first : 0f;
                weights[place / 16, place % 16, 2] = first > 0f ? 0f : 1f;
            }
            data.SetAlphamaps(0, 0, weights);
            Make("Ground").AddComponent<TerrainCollider>().terrainData = data;
            MaterialMaps.Poll();
            uint[] found = new[] { 0.1f, 0.35f, 0.6f, 0.9f }
                .Select(x => Touch(new Vector3(x, 0.001f, 0.5f)).Relief).ToArray();
            (uint ofFirst, uint ofSecond) = (map.Rules[0].Relief!.Number, map.Rules[1].Relief!.Number);
            Assert.That(found, Is.EqualTo(new[] { ofFirst, ofFirst, ofSecond, 0u }));
            map.Rules[0].Relief = null;
            Assert.That(Touch(new Vector3(0.1f, 0.001f, 0.5f)).Relief, Is.Zero, "a layer without one");
        }

        [TestCase("sphere")]
        [TestCase("convex mesh")]
        [TestCase("unreadable mesh")]
        [TestCase("mesh without coordinates")]
        public void ElsewhereTheSurfaceIsFeltWithoutItsRelief(string kind)
        {
            HapticSurface surface = kind == "sphere"
                ? Tagged<SphereCollider>("wood", sphere => (sphere.radius, sphere.center) = (0.1f, -0.1f * Vector3.up))
                : Tagged<MeshCollider>("wood", collider =>
                {
                    collider.sharedMesh = Sheet();
                    collider.convex = kind == "convex mesh";
                    if (kind == "unreadable mesh")
                    {
                        collider.sharedMesh!.UploadMeshData(true);
                    }
                    if (kind == "mesh without coordinates")
                    {
                        collider.sharedMesh!.uv = Array.Empty<Vector2>();
                    }
                });
            surface.Relief = Keep(Ribs());
            ContactState state = Touch(new Vector3(0f, 0.001f, 0.01f));
            Assert.That(state.Touching, Is.True);
            Assert.That(state.Relief, Is.Zero);
        }

        [Test]
        public void ARuleCanHaveARelief()
        {
            HapticMaterialMap map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.Add(HapticMaterialRule.ForName("Plank", Feeling("wood")));
            map.Rules[0].Relief = Keep(Ribs());
            HaptoFlowSettings.Active.MaterialMap = map;
            Bare();
            MaterialMaps.Poll();
            Expect(Touch(new Vector3(0.03f, 0.001f, -0.05f)), 0.5f + 0.3f, 0.5f - 0.25f);
        }

        [Test]
        public void AReliefIsFeltWhereOneIsAssignedAndCostsNothingElsewhere()
        {
            double without = LevelOfAStroke(null, out EffectStatistics off);
            EndScene();
            BeginScene();
            double with = LevelOfAStroke(Keep(Ribs()), out EffectStatistics on);
            Assert.That((off.IsAskedFor, off.Runs, off.Prepared), Is.EqualTo((false, 0UL, 0UL)));
            Assert.That(on.IsAskedFor, Is.True);
            Assert.That(on.Runs, Is.GreaterThan(100UL));
            Assert.That(with, Is.GreaterThan(2.0 * without));
        }

        [Test]
        public void ASurfaceWithoutOtherEffectsCanHaveAReliefAlone()
        {
            double level = LevelOfAStroke(
                Keep(Ribs()), out _, material => material.Effects = HapticEffects.Nothing);
            Assert.That(level, Is.GreaterThan(0.005));
        }

        [Test]
        public void TheLibraryHasOneCopyUntilTheHeightsChangeOrTheAssetGoes()
        {
            HapticRelief relief = Ribs();
            uint first = relief.Number;
            Assert.That(first, Is.Not.Zero);
            HapticSession.ShutDown();
            Assert.That(relief.Number, Is.EqualTo(first), "it belongs to no session");
            relief.Share = 0.2f;
            Assert.That(relief.Number, Is.EqualTo(first));
            relief.DepthMillimetres = 0.3f;
            uint second = relief.Number;
            Assert.That(second, Is.Not.Zero.And.Not.EqualTo(first));
            Assert.That(IsGone(first), Is.True);
            // As at a reload of the domain, which disables every asset first.
            UnityEngine.Object.DestroyImmediate(relief);
            Assert.That(IsGone(second), Is.True);
        }

        [Test]
        public void ARefusedReliefIsReportedOnceAndNotFelt()
        {
            HapticRelief relief = Keep(Ribs());
            relief.name = "Waves";
            relief.SizeMetres = new Vector2(float.PositiveInfinity, 1f);
            Log.Clear();
            Assert.That((relief.Number, relief.Number), Is.EqualTo((0u, 0u)));
            Assert.That(Log.Lines.Single().Text, Does.Match("relief Waves is not felt: .*size"));
            relief.SizeMetres = new Vector2(1f, 1f);
            Assert.That(relief.Number, Is.Not.Zero);
        }

        [Test]
        public void HeightsOfAnotherNumberOrTooManyAreRefused()
        {
            HapticRelief relief = Keep(ScriptableObject.CreateInstance<HapticRelief>());
            Assert.That(relief.Number, Is.Zero);
            Assert.That(() => relief.SetHeights(2, 2, new float[3]),
                Throws.ArgumentException.With.Message.Contains("4 heights, but 3"));
            Assert.That(() => relief.SetHeights(2048, 2048, new float[1]),
                Throws.ArgumentException.With.Message.Contains("3145728").And.Message.Contains("halve"));
            Assert.That(relief.IsBaked, Is.False);
            relief.SetHeights(2, 1, new[] { -1f, 0.5f });
            Assert.That((relief.HeightAt(0, 0), relief.HeightAt(1, 0)), Is.EqualTo((0f, 32768f / 65535f)));
        }

        private static unsafe bool IsGone(uint number) => NativeMethods.ReliefDestroy(&number) != 0;

        private static void Expect(in ContactState state, float column, float row)
        {
            Assert.That(state.ReliefPlace.Column, Is.EqualTo(column).Within(Slack));
            Assert.That(state.ReliefPlace.Row, Is.EqualTo(row).Within(Slack));
        }

        /// <summary>The direction in the world in which the map goes on over a face of a box of 20 cm, as long as a metre
        /// leads in it.</summary>
        private Vector3 Way(Vector3 outward, Func<MapPlace, float> of)
        {
            const float Step = 0.004f;
            Vector3 way = Vector3.zero;
            foreach (Vector3 axis in new[] { Vector3.right, Vector3.up, Vector3.forward })
            {
                if (Vector3.Dot(axis, outward) == 0f)
                {
                    float change = of(Touch(0.101f * outward + Step * axis).ReliefPlace) -
                        of(Touch(0.101f * outward).ReliefPlace);
                    way += change / Step * axis;
                }
            }
            return way;
        }

        /// <summary>The state of a tip that rests at a place of the world, as a stylus publishes it.</summary>
        private ContactState Touch(Vector3 tip, double scale = 1.0)
        {
            FinishLoading();
            Physics.SyncTransforms();
            var contacts = new TipContacts(0.002 / scale, Make("Pen").transform) { Scale = scale };
            ContactReading reading = default;
            for (int frame = 0; frame < 3; ++frame)
            {
                reading = contacts.Update(new TipSample(frame / 90.0, tip.ToDouble() / scale), double.NaN, ~0,
                    HapticSession.Current, contacts.Touched?.Collider!);
            }
            ReliefPlace.Write(contacts.Touched, ref reading);
            return reading.State;
        }

        /// <summary>The RMS level of the output while a board is stroked at 0.1 m/s across the ribs.</summary>
        private double LevelOfAStroke(
            HapticRelief? relief, out EffectStatistics effect, Action<MaterialDescription>? describe = null)
        {
            FinishLoading();
            HapticSurface board = Board();
            board.Relief = relief;
            describe?.Invoke(board.Material);
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.1f * (float)seconds - 0.15f, 0.001f, 0f));
            World.Frames(45);
            AudioDevice.Forget();
            World.Frames(90);
            effect = StatisticsOf(stylus, HapticEffect.Relief);
            return Math.Sqrt(AudioDevice.Samples().Average(sample => Math.Pow(sample, 2.0)));
        }
    }
}
