#nullable enable
using System;
using HaptoFlow.Contact;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>What a stylus did during a trial: how long it touched, how far and fast it slid, how hard it pressed,
    /// how often it set off and stopped. Main thread; no garbage while it counts.</summary>
    public sealed class TrialContact : IDisposable
    {
        /// <summary>A tip at rest sets off at this speed, in m/s, as for an output's signal.</summary>
        public const double SetsOffMps = MotionGate.SetsOffMps;

        /// <summary>A moving tip comes to rest below this speed, in m/s.</summary>
        public const double RestsMps = MotionGate.RestsMps;

        private readonly HapticStylus stylus;
        private readonly HapticSurface? surface;
        private readonly MotionGate motion = new MotionGate();
        private double lastSeconds;
        private double newtonSeconds;
        private double pathMetres;
        private ulong underrunsBefore;

        /// <summary>Counts from now on.</summary>
        /// <param name="surface">What is touched elsewhere does not count; null for everything.</param>
        public TrialContact(HapticStylus stylus, HapticSurface? surface = null)
        {
            this.stylus = stylus;
            this.surface = surface;
            stylus.TouchBegan += OnBegan;
            stylus.TouchMoved += OnMoved;
            stylus.TouchEnded += OnEnded;
            Begin();
        }

        /// <summary>The tip touches and moves over a surface that stands still. Also between trials.</summary>
        public bool IsMoving { get; private set; }

        /// <summary>How long the tip touched.</summary>
        public double ContactSeconds { get; private set; }

        /// <summary>How far it slid on what it touched, in mm.</summary>
        public double PathMillimetres => 1000.0 * pathMetres;

        /// <summary>Path over contact time, in mm/s; 0 without contact.</summary>
        public double MeanSpeedMmps => ContactSeconds > 0.0 ? PathMillimetres / ContactSeconds : 0.0;

        /// <summary>Over the contact time, in N; 0 without contact.</summary>
        public double MeanForceNewtons => ContactSeconds > 0.0 ? newtonSeconds / ContactSeconds : 0.0;

        /// <summary>How often the tip set off.</summary>
        public int Starts { get; private set; }

        /// <summary>How often it came to rest, or lifted while it slid.</summary>
        public int Stops { get; private set; }

        /// <summary>Audio blocks for which no segment was there.</summary>
        public ulong Underruns
        {
            get
            {
                ulong now = UnderrunsByNow();
                // A voice that was opened anew counts from zero.
                return now >= underrunsBefore ? now - underrunsBefore : now;
            }
        }

        /// <summary>A trial begins: everything counts from zero.</summary>
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

        /// <summary>Writes the columns that all studies have.</summary>
        public TrialRecord AddTo(TrialRecord record) => record
            .Set("contact_seconds", ContactSeconds)
            .Set("path_mm", PathMillimetres)
            .Set("mean_speed_mmps", MeanSpeedMmps)
            .Set("mean_force_newtons", MeanForceNewtons)
            .Set("underruns", Underruns);

        /// <summary>Counts no more.</summary>
        public void Dispose()
        {
            stylus.TouchBegan -= OnBegan;
            stylus.TouchMoved -= OnMoved;
            stylus.TouchEnded -= OnEnded;
        }

        private void OnBegan(HapticStylus told, in HapticContact contact)
        {
            lastSeconds = NowSeconds();
            Move(motion.Update(lastSeconds, Counts(contact), contact.Point.ToDouble()));
        }

        private void OnMoved(HapticStylus told, in HapticContact contact)
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

        private void OnEnded(HapticStylus told, in HapticContact contact) =>
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
