using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>Worlds that spawn, swap and load for hours: what is kept and what a frame costs stay flat.</summary>
    public sealed class SpawnTests : SceneTest
    {
        private const int Spawns = 10000;
        private const int InOneFrame = 4;

        private HapticMaterialMap map = null!;
        private TerrainLayer[] layers = null!;

        [SetUp]
        public void MakeAMapOfTwoLayers()
        {
            FinishLoading();
            map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            layers = new[] { new TerrainLayer { name = "grass" }, new TerrainLayer { name = "rock" } };
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[0], Feeling("wood")));
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[1], Feeling("stone")));
            map.Add(HapticMaterialRule.ForName("Crate", Feeling("wood")));
            HaptoFlowSettings.Active.MaterialMap = map;
        }

        [Test]
        public void TenThousandSpawnsBelowASurfaceLeaveNothingAndCostTheSameInEveryFrame()
        {
            HaptoFlowSettings.Active.MaterialMap = null;
            HapticSurface surface = Board();
            Transform pool = Make("Pool").transform;
            pool.SetParent(surface.transform, false);
            Circling();
            long[] searches = SpawnAndCount(() => SpawnBelow(pool));
            Assert.That(surface.Colliders.Count, Is.EqualTo(1 + InOneFrame));
            Assert.That(surface.Colliders, Has.None.Matches<Collider>(collider => collider == null));
            Assert.That(SurfaceRegistry.Count, Is.LessThan(600));
            AssertFlat(searches);
        }

        [Test]
        public void TenThousandSpawnsThatRulesMatchLeaveABoundedCacheAndCostTheSameInEveryFrame()
        {
            Transform root = Make("Root").transform;
            Circling();
            AssertFlat(SpawnAndCount(() => SpawnBelow(root)));
            Assert.That(MappedColliders.Count, Is.LessThan(600));
            World.LoadEmptyScene();
            Assert.That(MappedColliders.Count, Is.Zero, "what a scene unloads is forgotten at once");
        }

        [Test]
        public void TenThousandSwapsOfAMeshUnderTheTipKeepOneEntry()
        {
            GameObject crate = SpawnBelow(Make("Root").transform);
            Object.DestroyImmediate(crate.GetComponent<BoxCollider>());
            crate.transform.localPosition = new Vector3(0f, -0.15f, 0f);
            var collider = crate.AddComponent<MeshCollider>();
            HapticStylus stylus = Circling();
            for (int swap = 0; swap < Spawns; ++swap)
            {
                Mesh? before = collider.sharedMesh;
                collider.sharedMesh = TestMeshes.Box(0.3f);
                Object.DestroyImmediate(before!);
                if (swap % InOneFrame == 0)
                {
                    World.Frame();
                }
            }
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(MappedColliders.Count, Is.EqualTo(1));
            Assert.That(MappedColliders.Resolve(collider)!.Facts.Mesh, Is.SameAs(collider.sharedMesh));
        }

        [Test]
        public void ScenesWithTerrainsThatComeAndGoLeaveNoTerrainBehind()
        {
            HapticStylus stylus = Circling();
            Object.DontDestroyOnLoad(stylus.gameObject);
            Object.DontDestroyOnLoad(Stepper.gameObject);
            for (int load = 0; load < 200; ++load)
            {
                Tile(64, Vector3.zero);
                World.Frames(3);
                Assert.That(stylus.IsTouching, Is.True);
                Assert.That(TerrainWeights.Count, Is.EqualTo(1));
                World.LoadEmptyScene();
                Assert.That(TerrainWeights.Count, Is.Zero, $"load {load}");
                World.Frames(2);
            }
            Assert.That(TerrainWeights.StripsRead, Is.LessThanOrEqualTo(2 * 200));
        }

        [Test]
        public void ATileThatIsLoadedLaterIsReadBeforeItIsTouchedOneStripAFrame()
        {
            bool lands = false;
            StylusAlong(_ => new Vector3(0.3f, lands ? 0.001f : 1f, 0.3f));
            World.Frames(50);
            Tile(512, Vector3.zero);
            Assert.That(StripsOf(60), Is.EqualTo(512 / 64), "all eight strips");
            lands = true;
            Assert.That(StripsOf(10), Is.Zero, "a touch has nothing left to read");
        }

        [Test]
        public void ATileUnderTheTipCostsTheStripsThereAndOneMoreAndFeelsRightAtOnce()
        {
            HapticStylus stylus = StylusAlong(_ => new Vector3(0.3f, 0.001f, 0.3f));
            World.Frames(50);
            TerrainCollider tile = Tile(1024, Vector3.zero, z => z > 0.5f);
            long before = TerrainWeights.StripsRead;
            World.Frame();
            Assert.That(TerrainWeights.StripsRead - before, Is.LessThanOrEqualTo(3));
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(Felt(stylus), Is.EqualTo("stone"));
            StripsOf(60);
            Paint(tile, 1024, _ => false);
            Assert.That(StripsOf(1), Is.LessThanOrEqualTo(3), "paint costs no more");
            Assert.That(Felt(stylus), Is.EqualTo("wood"));
        }

        [Test]
        public void ATerrainThatChangesItsResolutionOrLayersIsReadAnew()
        {
            HapticStylus stylus = StylusAlong(_ => new Vector3(0.3f, 0.001f, 0.3f));
            TerrainCollider tile = Tile(256, Vector3.zero, _ => true);
            World.Frames(50);
            Assert.That(Felt(stylus), Is.EqualTo("stone"));
            tile.terrainData!.alphamapResolution = 64;
            World.Frames(2);
            Assert.That(Felt(stylus), Is.EqualTo("wood"), "the shim paints the first layer");
            tile.terrainData.terrainLayers = layers.Take(1).ToArray();
            World.Frames(2);
            Assert.That(Felt(stylus), Is.EqualTo("wood"));
        }

        [Test]
        public void ATerrainOfOneMaterialIsNotRead()
        {
            map.Clear();
            map.Add(HapticMaterialRule.ForName("Tile", Feeling("wood")));
            Circling();
            Tile(512, Vector3.zero);
            Assert.That(StripsOf(60), Is.Zero);
        }

        private long[] SpawnAndCount(Func<GameObject> spawn)
        {
            var living = new Queue<GameObject>();
            var searches = new List<long>();
            for (int frame = 0; frame < Spawns / InOneFrame; ++frame)
            {
                for (int each = 0; each < InOneFrame; ++each)
                {
                    living.Enqueue(spawn());
                    if (living.Count > InOneFrame)
                    {
                        Object.Destroy(living.Dequeue());
                    }
                }
                long before = ComponentSearchCount<HapticSurface>.Searches;
                World.Frame();
                searches.Add(ComponentSearchCount<HapticSurface>.Searches - before);
            }
            return searches.ToArray();
        }

        private static void AssertFlat(long[] searches)
        {
            double early = searches.Skip(100).Take(400).Average();
            double late = searches.Skip(searches.Length - 400).Average();
            Assert.That(late, Is.LessThanOrEqualTo(1.05 * early));
        }

        private static GameObject SpawnBelow(Transform parent)
        {
            var crate = new GameObject("Crate");
            crate.transform.SetParent(parent, false);
            BoxCollider box = crate.AddComponent<BoxCollider>();
            (box.size, box.center) = (new Vector3(0.2f, 0.01f, 0.2f), new Vector3(0f, -0.015f, 0f));
            return crate;
        }

        /// <summary>A flat square of 1 m about a place; the second layer where asked for, else the first.</summary>
        private TerrainCollider Tile(int resolution, Vector3 centre, Func<float, bool>? isRock = null)
        {
            var data = new TerrainData { heightmapResolution = 33, size = new Vector3(1f, 0.1f, 1f) };
            data.alphamapResolution = resolution;
            data.terrainLayers = layers;
            GameObject owner = Terrain.CreateTerrainGameObject(data);
            owner.name = "Tile";
            owner.transform.position = centre - new Vector3(0.5f, 0f, 0.5f);
            var tile = owner.GetComponent<TerrainCollider>();
            if (isRock != null)
            {
                Paint(tile, resolution, isRock);
            }
            return tile;
        }

        private static void Paint(TerrainCollider tile, int resolution, Func<float, bool> isRock)
        {
            var weights = new float[resolution, resolution, 2];
            for (int z = 0; z < resolution; ++z)
            {
                for (int x = 0; x < resolution; ++x)
                {
                    weights[z, x, isRock(z / (resolution - 1f)) ? 1 : 0] = 1f;
                }
            }
            tile.terrainData!.SetAlphamaps(0, 0, weights);
        }

        /// <summary>The strips that frames read, of which none may read two.</summary>
        private static long StripsOf(int frames)
        {
            long all = 0;
            for (int frame = 0; frame < frames; ++frame)
            {
                long before = TerrainWeights.StripsRead;
                World.Frame();
                all += TerrainWeights.StripsRead - before;
                Assert.That(TerrainWeights.StripsRead - before, Is.LessThanOrEqualTo(frames == 1 ? 3 : 1));
            }
            return all;
        }

        private static string Felt(HapticStylus stylus)
        {
            LabelBlend blend = stylus.Contact.Labels;
            Assert.That(blend.Count, Is.EqualTo(1));
            return HapticSession.Current.Labels.All[blend.Label(0)];
        }
    }
}
