#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    /// <summary>A scene with listener, tagged objects and styluses, destroyed after each test. Its engine has no worker
    /// and is stepped once a frame.</summary>
    public abstract class SceneTest
    {
        private readonly List<Object> made = new List<Object>();

        /// <summary>Steps the engine; tests whose engine has a worker destroy it.</summary>
        internal EngineStepper Stepper { get; private set; } = null!;

        [SetUp]
        public void BeginScene()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.World.EnterPlayMode();
#endif
            HapticSession.ShutDown();
            HapticSession.OptionsOverride = new HapticEngineOptions { WithoutWorker = true, FixedLeadMs = 8.0, Seed = 3 };
            var settings = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            settings.Model = DefaultModel.Asset();
            settings.Quality = HapticQuality.Draft;
            HaptoFlowSettings.Active = settings;
            Make("Listener").AddComponent<AudioListener>();
            Stepper = Make("Stepper").AddComponent<EngineStepper>();
        }

        [TearDown]
        public void EndScene()
        {
            foreach (Object each in made)
            {
                Object.DestroyImmediate(each);
            }
            made.Clear();
            HapticSession.ShutDown();
            HapticSession.OptionsOverride = null;
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.World.ExitPlayMode();
            Assert.That(UnityShim.AudioDevice.Failure, Is.Null, "the audio thread threw");
            Assert.That(UnityShim.Log.Lines, Has.None.Matches<(LogType Type, string Text)>(
                line => line.Type == LogType.Exception));
#endif
        }

        internal GameObject Make(string name)
        {
            var gameObject = new GameObject(name);
            made.Add(gameObject);
            return gameObject;
        }

        internal T Keep<T>(T asset)
            where T : Object
        {
            made.Add(asset);
            return asset;
        }

        internal HapticMaterial Feeling(string label, Action<MaterialDescription>? change = null)
        {
            HapticMaterial material = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            material.name = label;
            material.Description.Label = label;
            change?.Invoke(material.Description);
            return material;
        }

        internal HapticSurface Tagged<TCollider>(string label, Action<TCollider>? shape = null)
            where TCollider : Collider
        {
            GameObject owner = Make(label);
            var collider = owner.AddComponent<TCollider>();
            shape?.Invoke(collider);
            var surface = owner.AddComponent<HapticSurface>();
            surface.Material.Label = label;
            return surface;
        }

        /// <summary>A square board of 2 cm whose top is the plane y = 0.</summary>
        internal HapticSurface Board(string label = "wood", float metres = 0.4f)
        {
            var surface = Bare(label, metres).gameObject.AddComponent<HapticSurface>();
            surface.Material.Label = label;
            return surface;
        }

        /// <summary>A board without a surface.</summary>
        internal BoxCollider Bare(string name = "Plank", float metres = 0.4f)
        {
            var box = Make(name).AddComponent<BoxCollider>();
            box.size = new Vector3(metres, 0.02f, metres);
            box.center = new Vector3(0f, -0.01f, 0f);
            return box;
        }

        /// <summary>A circle of 5 cm radius on the board, 1 mm deep, at 0.2 m/s.</summary>
        internal HapticStylus Circling() => StylusAlong(seconds => new Vector3(
            0.05f * (float)Math.Cos(4.0 * seconds), 0.001f, 0.05f * (float)Math.Sin(4.0 * seconds)));

        /// <summary>A stylus with a tip of 2 mm radius that follows a path.</summary>
        internal HapticStylus StylusAlong(Func<double, Vector3> path)
        {
            GameObject owner = Make("Stylus");
            owner.transform.position = path(0.0);
            owner.AddComponent<PathMover>().Path = path;
            return owner.AddComponent<HapticStylus>();
        }

        /// <summary>A stylus at rest 1 mm deep in the board.</summary>
        internal HapticStylus Resting(float x = 0f, float z = 0f) => StylusAlong(_ => new Vector3(x, 0.001f, z));

        internal static VoiceStatistics StatisticsOf(HapticStylus stylus)
        {
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            return statistics;
        }

        internal static EffectStatistics StatisticsOf(HapticStylus stylus, HapticEffect effect)
        {
            Assert.That(stylus.TryGetEffectStatistics(effect, out EffectStatistics statistics), Is.True);
            return statistics;
        }

        /// <summary>An output on an object of its own, with a tap that records it.</summary>
        internal AudioTap Output(out HapticOutput output)
        {
            GameObject owner = Make("Output");
            output = owner.AddComponent<HapticOutput>();
            return owner.AddComponent<AudioTap>();
        }

        /// <summary>Sets the frame rate outside Unity; Unity runs at its own.</summary>
        internal static void SetFrameRate(double hertz)
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.World.FrameRateHz = hertz;
#endif
        }

        internal static IEnumerator Frames(int count)
        {
            for (int frame = 0; frame < count; ++frame)
            {
                yield return null;
            }
        }

        /// <summary>Frames until a path has lasted so long.</summary>
        internal static IEnumerator Until(PathMover mover, double seconds)
        {
            while (mover.Seconds < seconds)
            {
                yield return null;
            }
        }

        /// <summary>The components of the scene, those of inactive objects too.</summary>
        internal static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);

        internal static void FinishLoading() => HapticSession.Current.FinishLoading();
    }
}
