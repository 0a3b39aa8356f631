using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Strokes of people, recorded with a pen on a real table, replayed on a board in a scene.</summary>
    public sealed class RealStrokesTests : SceneTest
    {
        private const float ReleaseDistanceMetres = 0.0005f;

        /// <summary>A tip of 5 mm stays in touch despite a few millimetres of tracking error, as in the native tests. A
        /// tip of 1 mm would lift off often.</summary>
        [TestCase(0.005f)]
        [TestCase(0.001f)]
        public void ARecordedStrokeTouchesOncePerLandingAndRendersFiniteSamples(float tipRadiusMetres)
        {
            if (RepositoryFiles.RealStrokes == null)
            {
                Assert.Ignore("../shared/strokes is not there: real strokes are no part of the repository");
            }
            Dictionary<string, List<double[]>> strokes = Read(RepositoryFiles.RealStrokes!);
            Assert.That(strokes.Count, Is.EqualTo(20));
            FinishLoading();
            foreach ((string name, List<double[]> samples) in strokes)
            {
                Play(name, samples, tipRadiusMetres);
            }
        }

        private void Play(string name, List<double[]> samples, float tipRadiusMetres)
        {
            (double height, Vector3 normal) = FitTable(samples);
            HapticSurface table = Tagged<BoxCollider>("wood", box =>
            {
                box.size = new Vector3(4f, 0.1f, 4f);
                box.center = new Vector3(0f, -0.05f, 0f);
            });
            table.transform.SetPositionAndRotation(
                new Vector3(0f, (float)height, 0f), Quaternion.FromToRotation(Vector3.up, normal));
            AudioTap tap = Output(out HapticOutput output);
            int last = 0;
            HapticStylus stylus = StylusAlong(seconds =>
            {
                // The tracker's last sample.
                for (; last + 1 < samples.Count && samples[last + 1][0] - samples[0][0] <= seconds; ++last)
                {
                }
                return PlaceOf(samples[last]);
            });
            stylus.TipRadiusMetres = tipRadiusMetres;
            stylus.Output = output;
            var log = new TouchLog(stylus);
            double length = samples[samples.Count - 1][0] - samples[0][0];
            int landings = 0;
            bool far = true;
            for (double seconds = 0.0; seconds < length; seconds += 1.0 / World.FrameRateHz)
            {
                World.Frame();
                float gap = Vector3.Dot(stylus.transform.position - table.transform.position, normal) - tipRadiusMetres;
                landings += far && gap < 0f ? 1 : 0;
                far = gap > ReleaseDistanceMetres || (far && gap >= 0f);
                HapticContact contact = stylus.Contact;
                float speed = Mathf.Sqrt(contact.FirstVelocityMps * contact.FirstVelocityMps +
                    contact.SecondVelocityMps * contact.SecondVelocityMps);
                Assert.That(speed, Is.LessThan(3f), $"{name} at {seconds:F2} s");
            }
            Assert.That(landings, Is.GreaterThan(0), name);
            Assert.That(log.Began, Is.LessThanOrEqualTo(landings), $"{name}: on and off more than once a landing");
            Assert.That(log.Ended, Is.LessThanOrEqualTo(landings), name);
            Assert.That(tap.BrokenSamples, Is.Zero, name);
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f), name);
            Assert.That(stylus.ContactStatistics.Teleports, Is.Zero, name);
            UnityEngine.Object.DestroyImmediate(stylus.gameObject);
            UnityEngine.Object.DestroyImmediate(table.gameObject);
            UnityEngine.Object.DestroyImmediate(output.gameObject);
        }

        /// <summary>The table is the x-y plane of the recordings.</summary>
        private static Vector3 PlaceOf(double[] sample) => new Vector3((float)sample[1], (float)sample[3], (float)sample[2]);

        private static Dictionary<string, List<double[]>> Read(string path) => File.ReadLines(path).Skip(1)
            .Select(line => line.Split(','))
            .GroupBy(cells => cells[0])
            .ToDictionary(group => group.Key, group => group
                .Select(cells => cells.Skip(1).Take(4).Select(cell => double.Parse(cell, CultureInfo.InvariantCulture)).ToArray())
                .ToList());

        /// <summary>The height over a plane fitted by iteratively re-weighted least squares, so that lifted parts of a
        /// stroke do not tilt it.</summary>
        private static (double Height, Vector3 Normal) FitTable(List<double[]> samples)
        {
            var plane = new double[3];
            for (int round = 0; round < 20; ++round)
            {
                var system = new double[3, 4];
                foreach (double[] sample in samples)
                {
                    double[] row = { 1.0, sample[1], sample[2], sample[3] };
                    double residual = sample[3] - plane[0] - plane[1] * sample[1] - plane[2] * sample[2];
                    double weight = round == 0 ? 1.0 : 1.0 / Math.Max(Math.Abs(residual), 1e-4);
                    for (int i = 0; i < 3; ++i)
                    {
                        for (int j = 0; j < 4; ++j)
                        {
                            system[i, j] += weight * row[i] * row[j];
                        }
                    }
                }
                plane = Solve(system);
            }
            return (plane[0], new Vector3((float)-plane[1], 1f, (float)-plane[2]).normalized);
        }

        private static double[] Solve(double[,] system)
        {
            for (int pivot = 0; pivot < 3; ++pivot)
            {
                for (int row = 0; row < 3; ++row)
                {
                    double factor = row == pivot ? 0.0 : system[row, pivot] / system[pivot, pivot];
                    for (int column = pivot; column < 4; ++column)
                    {
                        system[row, column] -= factor * system[pivot, column];
                    }
                }
            }
            return new[] { system[0, 3] / system[0, 0], system[1, 3] / system[1, 1], system[2, 3] / system[2, 2] };
        }
    }
}
