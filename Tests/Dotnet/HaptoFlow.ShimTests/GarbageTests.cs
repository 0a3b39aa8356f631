using System;
using System.Runtime.CompilerServices;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Frames and audio blocks make no garbage, whatever is touched.</summary>
    public sealed class GarbageTests : SceneTest
    {
        private const int WarmUpFrames = 90;
        private const int MeasuredFrames = 180;

        [Test]
        public void FramesWithoutTouchMakeNoGarbage() => Check(_ => new Vector3(0f, 0.3f, 0f), () => Board());

        [Test]
        public void SlidingOverABoxMakesNoGarbage() => Check(Circle(0.001f), () => Board());

        [Test]
        public void SlidingOverASphereACapsuleAndAControllerMakesNoGarbage() => Check(Circle(0.001f), () =>
        {
            Tagged<SphereCollider>("wood", sphere => sphere.radius = 0.06f);
            Tagged<CapsuleCollider>("fur", capsule => capsule.radius = 0.05f);
            Tagged<CharacterController>("fur", controller => controller.radius = 0.04f);
        });

        [Test]
        public void SlidingOverMeshesAndATerrainMakesNoGarbage() => Check(Circle(0.001f), () =>
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
        public void TouchingAndLiftingAgainAndAgainMakesNoGarbage() => Check(
            seconds => new Vector3(0.05f * (float)seconds, 0.001f + 0.01f * (float)Math.Sin(40.0 * seconds), 0f),
            () => Board());

        [Test]
        public void AMovingBodyMakesNoGarbage() => Check(Circle(0.001f), () =>
        {
            HapticSurface board = Board();
            board.Material.SecondLabel = "fur";
            board.Material.Blend = 0.5f;
            PlatformMover.On(board.gameObject, RigidbodyInterpolation.None, seconds =>
                new Vector3(0.02f * (float)Math.Sin(seconds), 0f, 0f));
        });

        [Test]
        public void SlidingOverALearntMaterialMakesNoGarbage() => Check(Circle(0.001f), () =>
        {
            HapticMaterial material =
                HapticMaterial.Create(Model.MaterialText.OfLabel(DefaultModel.Asset().File, "glass"), "fur");
            Board().SharedMaterial = material;
            HapticSession.Current.FinishRegistrations();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(1));
        });

        [Test]
        public void APenWhoseForceDecidesMakesNoGarbage() => Check(Circle(0.006f), () => Board(), stylus =>
        {
            stylus.Force = stylus.gameObject.AddComponent<SteadyForce>();
            stylus.TouchBy = TouchDecision.MeasuredForce;
        });

        [Test]
        public void TheInspectorsEventsMakeNoGarbage() => Check(
            seconds => new Vector3(0.05f * (float)seconds, 0.001f + 0.01f * (float)Math.Sin(40.0 * seconds), 0f),
            () => Board(),
            stylus =>
            {
                int told = 0;
                stylus.Events.TouchBegan.AddListener(_ => ++told);
                stylus.Events.TouchMoved.AddListener(_ => ++told);
                stylus.Events.TouchEnded.AddListener(_ => ++told);
            });

        [Test]
        public void AnUntaggedColliderNearTheTipMakesNoGarbage() => Check(Circle(0.001f), () =>
        {
            Board();
            GameObject bare = Make("bare");
            bare.transform.SetParent(Make("parent").transform, false);
            bare.AddComponent<BoxCollider>();
        });

        private static Func<double, Vector3> Circle(float height) => seconds =>
            new Vector3(0.04f * (float)Math.Cos(5.0 * seconds), height, 0.04f * (float)Math.Sin(5.0 * seconds));

        private void Check(Func<double, Vector3> path, Action makeScene, Action<HapticStylus>? tell = null)
        {
            FinishLoading();
            makeScene();
            Output(out _);
            HapticStylus stylus = StylusAlong(path);
            tell?.Invoke(stylus);
            var log = new TouchLog(stylus);
            World.Frames(WarmUpFrames);
            AudioDevice.Forget();
            long bytes = BytesOf(MeasuredFrames);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            Assert.That(statistics.Updates, Is.GreaterThan((ulong)MeasuredFrames));
            Assert.That(log.Began + log.Moved > 0 || path(0.0).y > 0.2f, Is.True, "nothing was touched");
            Assert.That(bytes, Is.Zero, "on the main thread");
            Assert.That(AudioDevice.AllocatedBytes, Is.Zero, "on the audio thread");
            Assert.That(AudioDevice.RecordedFrames, Is.GreaterThan(10000));
        }

        [MethodImpl(MethodImplOptions.NoInlining)]
        private static long BytesOf(int frames)
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            World.Frames(frames);
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }

        private sealed class SteadyForce : TipForceSource
        {
            public override bool TryRead(out float forceNewtons)
            {
                forceNewtons = 0.5f;
                return true;
            }
        }
    }
}
