#nullable enable
using System;
using HaptoFlow.Contact;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>Statistics of a stylus during a trial: contact time, path, speed, force, starts and stops. Main thread;
    /// no garbage.</summary>
    public sealed class TrialContact : IDisposable
    {
        /// <summary>Speed at which a tip at rest starts to move, in m/s, as for an output's signal.</summary>
        public const double StartSpeedMps = MotionGate.StartSpeedMps;

        /// <summary>Speed below which a moving tip comes to rest, in m/s.</summary>
        public const double StopSpeedMps = MotionGate.StopSpeedMps;

        private readonly HapticStylus stylus;
        private readonly HapticSurface? surface;
        private readonly MotionGate motion = new MotionGate();
        private double lastSeconds;
        private double newtonSeconds;
        private double pathMetres;
        private ulong underrunsBefore;

        /// <summary>Starts counting.</summary>
        /// <param name="surface">The only surface that counts; null for all.</param>
        public TrialContact(HapticStylus stylus, HapticSurface? surface = null)
        {
            this.stylus = stylus;
            this.surface = surface;
            stylus.TouchBegan += OnBegan;
            stylus.TouchMoved += OnMoved;
            stylus.TouchEnded += OnEnded;
            Begin();
        }

        /// <summary>True while the tip touches and moves over a surface at rest, also between trials.</summary>
        public bool IsMoving { get; private set; }

        /// <summary>Contact time.</summary>
        public double ContactSeconds { get; private set; }

        /// <summary>Length of the path on the touched surfaces, in mm.</summary>
        public double PathMillimetres => 1000.0 * pathMetres;

        /// <summary>Path over contact time, in mm/s; 0 without contact.</summary>
        public double MeanSpeedMmps => ContactSeconds > 0.0 ? PathMillimetres / ContactSeconds : 0.0;

        /// <summary>Mean force over the contact time, in N; 0 without contact.</summary>
        public double MeanForceNewtons => ContactSeconds > 0.0 ? newtonSeconds / ContactSeconds : 0.0;

        /// <summary>Number of starts of the motion.</summary>
        public int Starts { get; private set; }

        /// <summary>Number of stops of the motion, including lift-offs while sliding.</summary>
        public int Stops { get; private set; }

        /// <summary>Number of audio blocks without a segment.</summary>
        public ulong Underruns
        {
            get
            {
                ulong now = UnderrunsByNow();
                // The count of a voice that was reopened starts from zero.
                return now >= underrunsBefore ? now - underrunsBefore : now;
            }
        }

        /// <summary>Resets all statistics at the start of a trial.</summary>
        public void Begin()
        {
            ContactSeconds = 0.0;
            pathMetres = 0.0;
            newtonSeconds = 0.0;
            Starts = 0;
            Stops = 0;
            lastSeconds = NowSeconds();
            underrunsBefore = UnderrunsByNow();
        }

        /// <summary>Sets the columns that all studies have.</summary>
        public TrialRecord AddTo(TrialRecord record) => record
            .Set("contact_seconds", ContactSeconds)
            .Set("path_mm", PathMillimetres)
            .Set("mean_speed_mmps", MeanSpeedMmps)
            .Set("mean_force_newtons", MeanForceNewtons)
            .Set("underruns", Underruns);

        /// <summary>Stops counting.</summary>
        public void Dispose()
        {
            stylus.TouchBegan -= OnBegan;
            stylus.TouchMoved -= OnMoved;
            stylus.TouchEnded -= OnEnded;
        }

        private void OnBegan(HapticStylus sender, in HapticContact contact)
        {
            lastSeconds = NowSeconds();
            Move(motion.Update(lastSeconds, Counts(contact), contact.Point.ToDouble()));
        }

        private void OnMoved(HapticStylus sender, in HapticContact contact)
        {
            double now = NowSeconds();
            double passed = Math.Max(0.0, now - lastSeconds);
            lastSeconds = now;
            if (!Counts(contact))
            {
                Move(motion.Update(now, false, default));
                return;
            }
            float speedMps = contact.TangentialVelocity.magnitude;
            ContactSeconds += passed;
            pathMetres += passed * speedMps;
            newtonSeconds += passed * contact.ForceNewtons;
            Move(motion.Update(now, true, contact.Point.ToDouble()));
        }

        private void OnEnded(HapticStylus sender, in HapticContact contact) =>
            Move(motion.Update(NowSeconds(), false, default));

        private bool Counts(in HapticContact contact) =>
            surface is null || ReferenceEquals(surface, contact.Surface);

        private void Move(bool moves)
        {
            if (moves && !IsMoving)
            {
                ++Starts;
            }
            else if (!moves && IsMoving)
            {
                ++Stops;
            }
            IsMoving = moves;
        }

        private ulong UnderrunsByNow() =>
            stylus != null && stylus.TryGetStatistics(out VoiceStatistics statistics) ? statistics.Underruns : 0;

        private static double NowSeconds() =>
            Time.inFixedTimeStep ? Time.fixedUnscaledTimeAsDouble : Time.unscaledTimeAsDouble;
    }
}
