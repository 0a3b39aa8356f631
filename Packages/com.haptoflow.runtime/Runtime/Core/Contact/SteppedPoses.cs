#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The motion of a surface that is seen by its steps: physics slower or faster than the frames, network
    /// ticks, an animation of fewer frames, a slow tracker. Says when its poses were taken, by what makes its motion
    /// smoothest: in the frames that drew them, in the physics steps before, or in the regular steps at which they
    /// change.</summary>
    /// <remarks>Regular steps are a line through the frames of the last changes (least squares); a pose is not later
    /// than the frame that shows it, nor earlier than the frame before. After the first change that follows a rest
    /// nothing is known yet, and the step is spread over the time before.</remarks>
    internal sealed class SteppedPoses
    {
        // Motion is judged over this time, and over so many frames and changes at least: a hitch may be longer.
        private const double WindowSeconds = 0.3;
        private const int WindowFrames = 6;
        private const int WindowChanges = 3;

        // Another explanation than the frames must halve the changes of speed.
        private const double Better = 0.25;

        // Rounding and noise of a tracker make no steps.
        private const double LeastMps = 0.002;

        private const int MaximumChanges = 8;

        // A longer gap than so many steps is a rest.
        private const double RestSteps = 2.5;

        // A step further ahead than this is not guessed.
        private const double MaximumStepsAhead = 1.5;

        private const double ClockSlackSeconds = 1e-5;

        private readonly Double3[] points = new Double3[PoseHistory.Capacity];
        private readonly int[] changes = new int[MaximumChanges];
        private readonly Timeline frames = new Timeline();
        private readonly Timeline physics = new Timeline();
        private readonly Timeline regular = new Timeline();
        private PoseHistory track = new PoseHistory();
        private Timeline chosen;

        public SteppedPoses() => chosen = frames;

        public double FirstSeconds => chosen.Seconds(0);

        public bool IsEstimated => ReferenceEquals(chosen, regular);

        /// <summary>Judges a surface's motion. False where its poses are best taken as drawn in their frames.</summary>
        /// <param name="localPoint">The point of the surface whose motion is judged, in its coordinates.</param>
        public bool Find(PoseHistory history, Double3 localPoint)
        {
            track = history;
            chosen = frames;
            frames.Clear();
            double since = track.SecondsAt(WindowStart());
            for (int index = 0; index < track.Count; ++index)
            {
                points[index] = track.PoseAt(index).PointToWorld(localPoint);
                if (track.SecondsAt(index) >= since)
                {
                    frames.Add(track.SecondsAt(index), index);
                }
            }
            double drawn = MeanRoughness(frames);
            if (drawn < LeastMps * LeastMps)
            {
                return false;
            }
            double least = Better * drawn;
            double bySteps = FindRegularSteps() ? MeanRoughness(regular) : double.PositiveInfinity;
            if (bySteps < least)
            {
                least = bySteps;
                chosen = regular;
            }
            // The clock of physics is exact where it applies: among two good explanations it is the better one.
            if (FindPhysicsSteps(since) && MeanRoughness(physics) < Math.Max(least, LeastMps * LeastMps))
            {
                chosen = physics;
            }
            return !ReferenceEquals(chosen, frames);
        }

        /// <summary>The pose at a time, interpolated or extrapolated between the steps that <see cref="Find"/>
        /// found.</summary>
        public RigidPose PoseAt(double timeSeconds)
        {
            int right = 0;
            while (right < chosen.Count && chosen.Seconds(right) < timeSeconds)
            {
                ++right;
            }
            right = Math.Min(right, chosen.Count - 1);
            if (right == 0)
            {
                return track.PoseAt(chosen.Frame(0));
            }
            double from = chosen.Seconds(right - 1);
            double share = (timeSeconds - from) / (chosen.Seconds(right) - from);
            return RigidPose.Between(track.PoseAt(chosen.Frame(right - 1)), track.PoseAt(chosen.Frame(right)),
                Math.Min(share, 1.0 + MaximumStepsAhead));
        }

        /// <summary>The first frame of the window: in slow motion few of them show a step.</summary>
        private int WindowStart()
        {
            double newest = track.SecondsAt(track.Count - 1);
            int start = track.Count - 1;
            for (int changed = 0; start > 0; --start)
            {
                bool isLong = track.SecondsAt(start) <= newest - WindowSeconds && track.Count - start >= WindowFrames;
                if (isLong && changed >= WindowChanges)
                {
                    break;
                }
                changed += HasChanged(start) ? 1 : 0;
            }
            return start;
        }

        /// <summary>False where a pose changed in a frame without a physics step.</summary>
        private bool FindPhysicsSteps(double sinceSeconds)
        {
            physics.Clear();
            int changed = 0;
            for (int index = 0; index < track.Count; ++index)
            {
                double now = track.SecondsAt(index);
                double age = track.SinceStepSecondsAt(index);
                if (now < sinceSeconds)
                {
                    continue;
                }
                // The first pose is that of the step before it.
                bool isFirst = physics.Count == 0 && !double.IsNaN(age);
                bool hasStepped = isFirst || (now - age > physics.LastSeconds + ClockSlackSeconds &&
                    age < now - track.SecondsAt(index - 1) + ClockSlackSeconds);
                if (hasStepped)
                {
                    physics.Add(now - age, index);
                }
                bool hasChanged = !isFirst && index > 0 && HasChanged(index);
                changed += hasChanged ? 1 : 0;
                if (hasChanged && !hasStepped)
                {
                    return false;
                }
            }
            return changed >= 2;
        }

        /// <summary>False where no frame repeats a pose between changes.</summary>
        private bool FindRegularSteps()
        {
            int count = FindChanges();
            if (count == 0)
            {
                return false;
            }
            int newest = changes[0];
            int first = changes[count - 1];
            bool isAlternating = newest == track.Count - 1 && newest - first == count - 1 && count > 1;
            if (isAlternating)
            {
                return false;
            }
            regular.Clear();
            if (count == 1)
            {
                double seconds = track.SecondsAt(newest) - track.SecondsAt(newest - 1);
                double moved = Double3.Distance(points[newest], points[newest - 1]);
                regular.Add(track.SecondsAt(newest) - WindowSeconds, newest - 1);
                regular.Add(track.SecondsAt(newest), newest);
                return moved <= VelocitySettings.MaximumGainMps(seconds) * seconds;
            }
            AddSteps(count);
            return true;
        }

        /// <summary>The frames of the last changes of pose, newest first, back to a rest.</summary>
        private int FindChanges()
        {
            int count = 0;
            for (int index = track.Count - 1; index >= 1 && count < MaximumChanges; --index)
            {
                if (!HasChanged(index))
                {
                    continue;
                }
                if (count > 0)
                {
                    double gap = track.SecondsAt(changes[count - 1]) - track.SecondsAt(index);
                    double usual = count > 1
                        ? (track.SecondsAt(changes[0]) - track.SecondsAt(changes[count - 1])) / (count - 1)
                        : WindowSeconds / RestSteps;
                    // Each change is seen up to a frame late.
                    double frame = track.SecondsAt(index + 1) - track.SecondsAt(index);
                    if (gap > RestSteps * usual + 2.0 * frame)
                    {
                        break;
                    }
                }
                changes[count++] = index;
            }
            return count;
        }

        private void AddSteps(int count)
        {
            // Least squares over the numbers of the steps, oldest first.
            double meanNumber = 0.5 * (count - 1);
            double mean = 0.0;
            double slope = 0.0;
            double squares = 0.0;
            for (int number = 0; number < count; ++number)
            {
                int frame = changes[count - 1 - number];
                // A change is seen half a frame late on average.
                double seen = 0.5 * (track.SecondsAt(frame) + track.SecondsAt(frame - 1));
                mean += seen / count;
                slope += (number - meanNumber) * seen;
                squares += (number - meanNumber) * (number - meanNumber);
            }
            slope /= squares;
            for (int number = 0; number < count; ++number)
            {
                int frame = changes[count - 1 - number];
                double before = track.SecondsAt(frame - 1);
                double shown = track.SecondsAt(frame);
                double seconds = Vectors.Clamp(mean + (number - meanNumber) * slope, before, shown);
                if (number == 0)
                {
                    regular.Add(seconds - slope, frame - 1);
                }
                if (seconds > regular.LastSeconds)
                {
                    regular.Add(seconds, frame);
                }
            }
        }

        private bool HasChanged(int index) => !track.PoseAt(index).Equals(track.PoseAt(index - 1));

        private double MeanRoughness(Timeline timeline)
        {
            var motion = new Roughness();
            for (int step = 0; step < timeline.Count; ++step)
            {
                motion.Add(timeline.Seconds(step), points[timeline.Frame(step)]);
            }
            return motion.Squares / Math.Max(1, timeline.Count - 2);
        }

        /// <summary>Frames, and the times at which their poses were taken.</summary>
        private sealed class Timeline
        {
            private readonly double[] seconds = new double[PoseHistory.Capacity];
            private readonly int[] frames = new int[PoseHistory.Capacity];

            public int Count { get; private set; }

            public double LastSeconds => Count == 0 ? double.NegativeInfinity : seconds[Count - 1];

            public double Seconds(int step) => seconds[step];

            public int Frame(int step) => frames[step];

            public void Clear() => Count = 0;

            public void Add(double timeSeconds, int frame)
            {
                seconds[Count] = timeSeconds;
                frames[Count] = frame;
                ++Count;
            }
        }
    }
}
