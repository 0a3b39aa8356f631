#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The green marker that the pen follows. It moves on a circle, because a corner would slow the hand down,
    /// and stops between strokes.</summary>
    public sealed class Marker : MonoBehaviour
    {
        private const float SizeMetres = 0.012f;

        private LatencyStudySettings settings = null!;
        private Vector3 centre;
        private double startSeconds;
        private bool isRunning;

        public bool IsMoving { get; private set; }

        /// <summary>Whether every stroke and the stop after the last one are over.</summary>
        public bool IsDone { get; private set; }

        /// <param name="centre">The centre of the circle, on the surface.</param>
        public static Marker Create(LatencyStudySettings settings, Vector3 centre)
        {
            GameObject mark = SceneObjects.AddMark("Marker", PrimitiveType.Sphere, centre,
                new Vector3(SizeMetres, 0.2f * SizeMetres, SizeMetres), new Color(0.1f, 0.9f, 0.2f));
            var marker = mark.AddComponent<Marker>();
            marker.settings = settings;
            marker.centre = centre;
            marker.Wait();
            return marker;
        }

        /// <summary>Puts the marker at the beginning of its path, at rest.</summary>
        public void Wait()
        {
            isRunning = false;
            IsMoving = false;
            IsDone = false;
            transform.position = PositionAt(0.0);
        }

        /// <summary>Starts with a stop, then moves and stops as often as the settings say.</summary>
        public void Run()
        {
            Wait();
            isRunning = true;
            startSeconds = Time.unscaledTimeAsDouble;
        }

        /// <summary>The distance travelled since the start, in metres.</summary>
        /// <param name="seconds">The time since the start.</param>
        /// <param name="moves">Whether the marker moves at that time.</param>
        /// <param name="isDone">Whether every stroke and the stop after the last one are over at that time.</param>
        public double DistanceAt(double seconds, out bool moves, out bool isDone)
        {
            double cycle = settings.restSeconds + settings.moveSeconds;
            double strokesDone = Math.Min(Math.Max(0.0, Math.Floor(seconds / cycle)), settings.strokes);
            double sinceRest = seconds - strokesDone * cycle - settings.restSeconds;
            double moving = Math.Min(Math.Max(0.0, sinceRest), settings.moveSeconds);
            isDone = strokesDone >= settings.strokes && seconds >= strokesDone * cycle + settings.restSeconds;
            moves = strokesDone < settings.strokes && moving > 0.0 && moving < settings.moveSeconds;
            double movedSeconds =
                strokesDone * settings.moveSeconds + (strokesDone < settings.strokes ? moving : 0.0);
            return 0.001 * settings.markerSpeedMmps * movedSeconds;
        }

        private void Update()
        {
            if (isRunning)
            {
                double distance = DistanceAt(
                    Time.unscaledTimeAsDouble - startSeconds, out bool moves, out bool isDone);
                IsMoving = moves;
                IsDone = isDone;
                transform.position = PositionAt(distance);
            }
        }

        private Vector3 PositionAt(double distanceMetres)
        {
            double radius = 0.001 * settings.markerRadiusMillimetres;
            double angle = distanceMetres / radius;
            return centre + (float)radius * new Vector3((float)Math.Cos(angle), 0f, (float)Math.Sin(angle));
        }
    }
}
