using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>A test of a sample's scene, with the camera of the scene file and simulated input.</summary>
    public abstract class SampleTest : SceneTest
    {
        protected const float Audible = 0.001f;

        [SetUp]
        public void ResetTheInput() => SimulatedInput.Reset();

        /// <summary>Creates the camera of a scene file.</summary>
        internal Camera CameraOf(SceneFile scene)
        {
            GameObject owner = Make("Main Camera");
            owner.transform.SetPositionAndRotation(scene.CameraPosition, scene.CameraRotation);
            var camera = owner.AddComponent<Camera>();
            camera.fieldOfView = scene.FieldOfView;
            return camera;
        }

        /// <summary>Adds the component that builds the scene, and wakes it after its fields have been set.</summary>
        internal TBootstrap Wake<TBootstrap>(Action<TBootstrap> configure)
            where TBootstrap : MonoBehaviour
        {
            GameObject owner = Make("Bootstrap");
            owner.SetActive(false);
            var bootstrap = owner.AddComponent<TBootstrap>();
            configure(bootstrap);
            owner.SetActive(true);
            return bootstrap;
        }

        /// <summary>Moves the mouse over a place of the scene.</summary>
        internal static void PointAt(Camera camera, Vector3 place) =>
            SimulatedInput.MousePosition = camera.WorldToScreenPoint(place);

        internal static void PlayFor(double seconds) => World.Frames((int)Math.Ceiling(seconds * World.FrameRateHz));

        /// <summary>The largest magnitude that reached the audio device since <see cref="AudioDevice.Forget"/>.
        /// </summary>
        internal static float Loudest()
        {
            float loudest = 0f;
            for (int frame = 0; frame < AudioDevice.RecordedFrames; ++frame)
            {
                loudest = Math.Max(loudest, Math.Abs(AudioDevice.Sample(frame, 0)));
            }
            return loudest;
        }

        internal static ulong InferencesOf(HapticStylus stylus)
        {
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True, "the stylus has no voice");
            return statistics.Inferences;
        }
    }

    /// <summary>Reads the camera of a sample's scene, which is YAML.</summary>
    internal sealed class SceneFile
    {
        public SceneFile(string sample)
        {
            string[] objects = Regex.Split(File.ReadAllText(SampleFiles.Scene(sample)), "^--- ", RegexOptions.Multiline);
            string camera = objects.Single(text => text.Contains("\nCamera:"));
            string owner = Regex.Match(camera, @"m_GameObject: (\{fileID: \d+\})").Groups[1].Value;
            string place = objects.Single(
                text => text.Contains("\nTransform:") && text.Contains("m_GameObject: " + owner));
            float[] position = Numbers(place, "m_LocalPosition");
            float[] rotation = Numbers(place, "m_LocalRotation");
            CameraPosition = new Vector3(position[0], position[1], position[2]);
            CameraRotation = new Quaternion(rotation[0], rotation[1], rotation[2], rotation[3]);
            FieldOfView = float.Parse(
                Regex.Match(camera, "field of view: (.*)").Groups[1].Value, CultureInfo.InvariantCulture);
        }

        public Vector3 CameraPosition { get; }

        public Quaternion CameraRotation { get; }

        public float FieldOfView { get; }

        private static float[] Numbers(string text, string key) =>
            Regex.Matches(Regex.Match(text, key + @": \{(.*)\}").Groups[1].Value, @"[xyzw]: ([-0-9.e]+)")
                .Select(match => float.Parse(match.Groups[1].Value, CultureInfo.InvariantCulture))
                .ToArray();
    }
}
