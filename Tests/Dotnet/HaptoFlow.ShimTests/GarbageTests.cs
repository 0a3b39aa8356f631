using System;
using System.Runtime.CompilerServices;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Frames and audio blocks allocate nothing, whatever is touched.</summary>
    public sealed class GarbageTests : SceneTest
    {
        private const int WarmUpFrames = 90;
        private const int MeasuredFrames = 180;

        [Test]
        public void FramesWithoutATouchAllocateNothing() => Check(_ => new Vector3(0f, 0.3f, 0f), () => Board());

        [Test]
        public void SlidingOverASphereACapsuleAndAControllerAllocatesNothing() => Check(Circle(0.001f), () =>
        {
            Tagged<SphereCollider>("wood", sphere => sphere.radius = 0.06f);
            Tagged<CapsuleCollider>("fur", capsule => capsule.radius = 0.05f);
            Tagged<CharacterController>("fur", controller => controller.radius = 0.04f);
        });

        [Test]
        public void SlidingOverMeshesAndATerrainAllocatesNothing() => Check(Circle(0.001f), () =>
        {
            Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = TestMeshes.Box(0.2f))
                .transform.position = new Vector3(0f, -0.1f, 0f);
            Tagged<MeshCollider>("fur", mesh =>
            {
                mesh.sharedMesh = TestMeshes.Box(0.1f);
                mesh.convex = true;
            }).transform.position = new Vector3(0f, -0.05f, 0f);
            Tagged<TerrainCollider>("stone", terrain => terrain.terrainData = new TerrainData { heightmapResolution = 5 })
                .transform.position = new Vector3(-0.5f, -0.001f, -0.5f);
        });

        [Test]
        public void TouchesAndTheirEventsInTheInspectorAllocateNothing() => Check(
            seconds => new Vector3(0.05f * (float)seconds, 0.001f + 0.01f * (float)Math.Sin(40.0 * seconds), 0f),
            () => Board(),
            stylus =>
            {
                int eventCount = 0;
                stylus.Events.TouchBegan.AddListener(_ => ++eventCount);
                stylus.Events.TouchMoved.AddListener(_ => ++eventCount);
                stylus.Events.TouchEnded.AddListener(_ => ++eventCount);
            });

        [Test]
        public void AMovingBodyAndAColliderWithoutASurfaceAllocateNothing() => Check(Circle(0.001f), () =>
        {
            HapticSurface board = Board();
            board.Material.SecondLabel = "fur";
            board.Material.Blend = 0.5f;
            GameObject bare = Make("bare");
            bare.transform.SetParent(Make("parent").transform, false);
            bare.AddComponent<BoxCollider>();
            PlatformMover.On(board.gameObject, RigidbodyInterpolation.None, seconds =>
                new Vector3(0.02f * (float)Math.Sin(seconds), 0f, 0f));
        });

        [Test]
        public void SlidingOverALearntMaterialAllocatesNothing() => Check(Circle(0.001f), () =>
        {
            HapticMaterial material =
                HapticMaterial.Create(Model.MaterialText.OfLabel(DefaultModel.Asset().File, "glass"), "fur");
            Board().SharedMaterial = material;
            HapticSession.Current.FinishRegistrations();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(1));
        });

        [Test]
        public void APenWithMeasuredForceAllocatesNothing() => Check(Circle(0.006f), () => Board(), stylus =>
        {
            var force = stylus.gameObject.AddComponent<FixedForce>();
            (force.ForceNewtons, stylus.Force) = (0.5f, force);
            stylus.TouchBy = TouchDecision.MeasuredForce;
        });

        [Test]
        public void CountingATrialAllocatesNothing() => Check(
            seconds => new Vector3(0.05f * (float)seconds, 0.001f + 0.01f * (float)Math.Sin(40.0 * seconds), 0f),
            () => Board(),
            stylus => new Studies.TrialContact(stylus));

        [Test]
        public void CollidersMatchedByManyRulesAllocateNothing() => Check(Circle(0.001f), () =>
        {
            HapticMaterialMap map = Map();
            for (int index = 0; index < 20; ++index)
            {
                map.Add(HapticMaterialRule.ForName("Nobody " + index, null));
                map.Add(HapticMaterialRule.ForTag("Player", Feeling("stone")));
            }
            map.DefaultMaterial = Feeling("wood");
            Bare().gameObject.AddComponent<MeshRenderer>();
            Make("Bystander").AddComponent<SphereCollider>().radius = 0.01f;
        });

        [Test]
        public void MovingBetweenKnownCollidersAllocatesNothing() => Check(
            seconds => new Vector3(0.4f * (float)Math.Sin(8.0 * seconds), 0.001f, 0f),
            () =>
            {
                HapticMaterialMap map = Map();
                map.Add(HapticMaterialRule.ForName("Key 1*", Feeling("stone")));
                map.DefaultMaterial = Feeling("wood");
                for (int index = 0; index < 60; ++index)
                {
                    var box = Make("Key " + index).AddComponent<BoxCollider>();
                    box.size = new Vector3(0.012f, 0.02f, 0.1f);
                    box.center = new Vector3(0.014f * (index - 30), -0.01f, 0f);
                }
            });

        [Test]
        public void TheLayersOfATerrainAllocateNothing() => Check(Circle(0.001f), () =>
        {
            HapticMaterialMap map = Map();
            var layers = new[] { new TerrainLayer { name = "grass" }, new TerrainLayer { name = "rock" } };
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[0], Feeling("fur")));
            map.Add(HapticMaterialRule.ForTerrainLayer(layers[1], Feeling("stone")));
            var data = new TerrainData { heightmapResolution = 5, terrainLayers = layers };
            data.SetAlphamaps(0, 0, Halves(data.alphamapResolution));
            GameObject ground = Make("Ground");
            ground.transform.position = new Vector3(-0.5f, 0f, -0.5f);
            ground.AddComponent<TerrainCollider>().terrainData = data;
        });

        [Test]
        public void SubmeshesAndAMaskAllocateNothing() => Check(Circle(0.001f), () =>
        {
            HapticMaterialMap map = Map();
            HapticMaskMap mask = ScriptableObject.CreateInstance<HapticMaskMap>();
            mask.SetPixels(2, 1, new[] { new Color32(0, 0, 0, 0), new Color32(255, 90, 200, 255) }, true);
            mask.Red.SetMaterial(Feeling("glass"));
            mask.Green.SetFactor(MaskChannelUse.Strength, 0.5f, 1f);
            mask.Blue.SetFactor(MaskChannelUse.FeatureScale, 0.5f, 2f);
            map.Add(HapticMaterialRule.ForSubmesh(null, 0, Feeling("wood")));
            map.Add(HapticMaterialRule.ForSubmesh(null, 1, Feeling("stone")));
            map.Rules[0].Mask = mask;
            var mesh = new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0f, 0f, -0.1f),
                    new Vector3(0f, 0f, 0.1f), new Vector3(0.1f, 0f, -0.1f), new Vector3(0.1f, 0f, 0.1f),
                },
                uv = new Vector2[6],
                subMeshCount = 2,
            };
            mesh.SetTriangles(new[] { 0, 1, 3, 0, 3, 2 }, 0);
            mesh.SetTriangles(new[] { 2, 3, 5, 2, 5, 4 }, 1);
            Make("Halves").AddComponent<MeshCollider>().sharedMesh = mesh;
        });

        [Test]
        public void AReliefOnABoxOrAMeshAllocatesNothing([Values] bool onMesh) => Check(Circle(0.001f), () =>
        {
            HapticSurface floor = onMesh
                ? Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = ReliefTests.Sheet())
                : Board();
            floor.Relief = Keep(ReliefTests.Ribs());
        });

        private static HapticMaterialMap Map()
        {
            HapticMaterialMap map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            HaptoFlowSettings.Active.MaterialMap = map;
            return map;
        }

        private static float[,,] Halves(int resolution)
        {
            var map = new float[resolution, resolution, 2];
            for (int place = 0; place < map.Length; ++place)
            {
                map[place / 2 / resolution, place / 2 % resolution, place % 2] = 0.5f;
            }
            return map;
        }

        private static Func<double, Vector3> Circle(float height) => seconds =>
            new Vector3(0.04f * (float)Math.Cos(5.0 * seconds), height, 0.04f * (float)Math.Sin(5.0 * seconds));

        private void Check(Func<double, Vector3> path, Action makeScene, Action<HapticStylus>? configure = null)
        {
            FinishLoading();
            makeScene();
            Output(out _);
            HapticStylus stylus = StylusAlong(path);
            configure?.Invoke(stylus);
            var log = new TouchLog(stylus);
            World.Frames(WarmUpFrames);
            AudioDevice.Forget();
            long bytes = BytesOf(MeasuredFrames);
            Assert.That(StatisticsOf(stylus).Updates, Is.GreaterThan((ulong)MeasuredFrames));
            Assert.That(log.Began + log.Moved > 0 || path(0.0).y > 0.2f, Is.True, "nothing was touched");
            Assert.That(bytes, Is.Zero, "on the main thread");
            Assert.That(AudioDevice.AllocatedBytes, Is.Zero, "on the audio thread");
            Assert.That(AudioDevice.RecordedFrames, Is.GreaterThan(10000));
        }

        [MethodImpl(MethodImplOptions.NoInlining)]
        internal static long BytesOf(int frames)
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            World.Frames(frames);
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }
    }
}
