#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The green marker that the pen follows: on a circle, where no corner slows a hand down, with stops.
    /// </summary>
    public sealed class Marker : MonoBehaviour
    {
        private const float SizeMetres = 0.012f;

        private LatencyStudySettings settings = null!;
        private Vector3 centre;
        private double beganSeconds;
        private bool isRunning;

        /// <summary>It is on its way; false at a stop.</summary>
        public bool IsMoving { get; private set; }

        /// <summary>Every stroke and the stop behind the last are over.</summary>
        public bool IsDone { get; private set; }

        /// <param name="centre">Of the circle, on the surface.</param>
        public static Marker Create(LatencyStudySettings settings, Vector3 centre)
        {
            GameObject made = Build.Solid("Marker", PrimitiveType.Sphere, centre,
                new Vector3(SizeMetres, 0.2f * SizeMetres, SizeMetres), new Color(0.1f, 0.9f, 0.2f));
            // The pen goes through it.
            made.GetComponent<Collider>().enabled = false;
            var marker = made.AddComponent<Marker>();
            marker.settings = settings;
            marker.centre = centre;
            marker.Wait();
            return marker;
        }

        /// <summary>At the beginning of its path, at rest.</summary>
        public void Wait()
        {
            isRunning = false;
            IsMoving = false;
            IsDone = false;
            transform.position = At(0.0);
        }

        /// <summary>Begins with a stop, then moves and stops as often as the settings say.</summary>
        public void Run()
        {
            Wait();
            isRunning = true;
            beganSeconds = Time.unscaledTimeAsDouble;
        }

        /// <summary>Way on the path since it began, in metres.</summary>
        /// <param name="seconds">Since it began.</param>
        /// <param name="moves">It is on its way then.</param>
        /// <param name="isDone">All is over then.</param>
        public double WayAt(double seconds, out bool moves, out bool isDone)
        {
            double cycle = settings.RestSeconds + settings.MoveSeconds;
            double whole = Math.Min(Math.Max(0.0, Math.Floor(seconds / cycle)), settings.Strokes);
            double sinceRest = seconds - whole * cycle - settings.RestSeconds;
            double moving = Math.Min(Math.Max(0.0, sinceRest), settings.MoveSeconds);
            isDone = whole >= settings.Strokes && seconds >= whole * cycle + settings.RestSeconds;
            moves = whole < settings.Strokes && moving > 0.0 && moving < settings.MoveSeconds;
            double strokeSeconds = whole * settings.MoveSeconds + (whole < settings.Strokes ? moving : 0.0);
            return 0.001 * settings.MarkerSpeedMmps * strokeSeconds;
        }

        private void Update()
        {
            if (isRunning)
            {
                double way = WayAt(Time.unscaledTimeAsDouble - beganSeconds, out bool moves, out bool isDone);
                IsMoving = moves;
                IsDone = isDone;
                transform.position = At(way);
            }
        }

        private Vector3 At(double wayMetres)
        {
            double radius = 0.001 * settings.MarkerRadiusMillimetres;
            double angle = wayMetres / radius;
            return centre + (float)radius * new Vector3((float)Math.Cos(angle), 0f, (float)Math.Sin(angle));
        }
    }
}
