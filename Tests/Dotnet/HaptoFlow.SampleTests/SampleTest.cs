using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;


namespace HaptoFlow.SampleTests
{
    /// <summary>A test of a sample's scene, with the camera of the scene file and simulated input.</summary>
    public abstract class SampleTest : SceneTest
    {
        protected const float Audible = 0.001f;
        protected const string Left = "<XRController>{LeftHand}/";
        protected const string Right = "<XRController>{RightHand}/";

        /// <summary>The camera of the scene that was opened last.</summary>
        private protected Camera camera = null!;

        /// <summary>A folder for what a scene writes, which creates it.</summary>
        private protected string folder = "";

        [SetUp]
        public void ResetTheInputAndChooseAFolder()
        {
            SimulatedInput.Reset();
            folder = Path.Combine(Path.GetTempPath(), "haptoflow-sample-" + Path.GetRandomFileName());
        }

        [TearDown]
        public void DeleteTheFolder()
        {
            if (Directory.Exists(folder))
            {
                Directory.Delete(folder, true);
            }
        }

        /// <summary>Builds a sample's scene with the camera of its scene file.</summary>
        /// <param name="configure">Sets further fields before the scene wakes.</param>
        internal TScene Open<TScene>(string sample, Action<TScene>? configure = null)
            where TScene : BuiltScene
        {
            camera = CameraOf(new SceneFile(sample));
            return Wake<TScene>(scene =>
            {
                scene.View = camera;
                configure?.Invoke(scene);
            });
        }

        /// <summary>Makes the camera carry the only Audio Listener, as in the studies' scene files.</summary>
        internal void ListenAtTheCamera()
        {
            foreach (AudioListener each in All<AudioListener>())
            {
                Object.DestroyImmediate(each);
            }
            camera.gameObject.AddComponent<AudioListener>();
        }


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

        internal static HapticStylus RightPen() => All<XrPen>().Single(pen => pen.Hand == PenHand.Right).Stylus!;

        internal void PointAt(Vector3 place) => SimulatedInput.MousePosition = camera.WorldToScreenPoint(place);

        internal void Press(Vector3 place, double seconds)
        {
            PointAt(place);
            SimulatedInput.MouseButton = true;
            PlayFor(seconds);
        }

        /// <summary>Presses a control for two frames.</summary>
        internal static void Press(string control)
        {
            SimulatedInput.SetControl(control, 1f);
            World.Frames(2);
            SimulatedInput.SetControl(control, 0f);
            World.Frames(2);
        }

        /// <summary>Tracks the device in a hand at a place, upright.</summary>
        internal static void Track(Vector3 place, string position = "tipPose/position", string hand = Right)
        {
            SimulatedInput.SetControl(hand + "isTracked", 1f);
            SimulatedInput.SetControl(hand + position, place);
            string rotation = position.Replace("Position", "Rotation").Replace("position", "rotation");
            SimulatedInput.SetControl(hand + rotation, Quaternion.identity);
        }

        /// <summary>Points with the controller in the right hand, to and fro over the jute of Stylus Tracing.</summary>
        internal static void PointOverTheJute(double seconds)
        {
            for (int frame = 0; frame < seconds * World.FrameRateHz; ++frame)
            {
                float x = 0.34f + 0.02f * (float)Math.Sin(2.0 * Math.PI * 2.0 * frame / World.FrameRateHz);
                Track(new Vector3(x, 0.013f, -0.12f), "pointerPosition");
                World.Frame();
            }
        }

        /// <summary>The fields of a type that Unity saves, without those of its base.</summary>
        internal static IEnumerable<FieldInfo> FieldsOf<T>() => typeof(T)
            .GetFields(BindingFlags.Instance | BindingFlags.DeclaredOnly | BindingFlags.Public | BindingFlags.NonPublic)
            .Where(field => field.IsPublic || field.GetCustomAttribute<SerializeField>() != null);

        internal static void PlayFor(double seconds) => World.Frames((int)Math.Ceiling(seconds * World.FrameRateHz));

        /// <summary>The samples of a channel of the audio device since <see cref="AudioDevice.Forget"/>.</summary>
        internal static float[] Channel(int channel) => Enumerable.Range(0, AudioDevice.RecordedFrames)
            .Select(frame => AudioDevice.Sample(frame, channel)).ToArray();

        /// <summary>Their largest magnitude.</summary>
        internal static float Loudest(int channel = 0) => Channel(channel).Select(Math.Abs).DefaultIfEmpty().Max();
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
