using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Tests.Support;
using UnityEngine;

namespace HaptoFlow.SampleTests
{
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
