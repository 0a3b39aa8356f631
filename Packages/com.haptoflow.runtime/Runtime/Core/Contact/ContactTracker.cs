#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The contact model: determines, frame by frame, what one stylus tip touches. One thread at a time; no
    /// garbage after construction.</summary>
    /// <remarks>
    /// <para>A frame consists of <see cref="BeginFrame"/>, one <see cref="Consider"/> for every surface near the tip,
    /// and <see cref="EndFrame"/>. The caller computes the geometry; the tracker decides.</para>
    /// <para>A touch begins when the tip sphere cuts into a surface, or passes through one between two frames, and ends
    /// when the gap exceeds the release distance. Among several surfaces the one that the tip's path entered first is
    /// chosen, else the deepest. The surface already touched is kept until another is deeper by the switch margin, and
    /// still would be for a tip that rests on the touched one: what lies below a thin mat does not replace it, a wall
    /// beside it does. Inside a surface the face that was entered is held (<see cref="HeldFace"/>), and beyond the far
    /// side of a thin one, too, while the tip is in another surface there.</para>
    /// <para>With <see cref="Force"/>, a measured tip force decides instead while one is measured: pressed, the nearest
    /// surface within reach is touched; lifted, none is.</para>
    /// </remarks>
    internal sealed class ContactTracker
    {
        // Limits the time step after a pause, so that transported tangent axes turn no further than in a slow frame.
        private const double MaximumFrameSeconds = 0.05;

        private const double HandSpeedMps = 4.0;
        private const double MaximumForceNewtons = 5.0;

        // Of surfaces that have none of their own and no label that gives one.
        private const double DefaultStiffnessNewtonsPerMetre = 500.0;

        // A touch ends when the gap between tip and surface exceeds this distance.
        private const double ReleaseDistanceMetres = 0.0005;

        // Another surface, or another face of the same one, is taken only when it is ahead by this distance.
        private const double SwitchMarginMetres = 0.0005;

        // A touch ends when the tip's position has been unusable for longer than this time.
        private const double LostSeconds = 0.100;
        private const double MaximumPathSeconds = 0.1;

        private readonly TipHistory history = new TipHistory();
        private readonly TouchedPath path;
        private readonly ContactTransitions transitions = new ContactTransitions();

        private double tipRadiusMetres;
        private TipSample sample;
        private double nowSeconds;
        private double stepSeconds;
        private bool started;
        private Double3? tipMetres;
        private double tipSeconds;

        private ContactBody? touched;
        private Double3? localNormal;

        // The touch began on the touched surface.
        private bool beganHere;

        // Time of the previous frame, from which the tip's path leads to this one; not a number after a jump.
        private double pathSeconds = double.NaN;
        private uint touchCounter;
        private double approachSpeedMps;
        private uint landingCounter;
        private uint edgeCounter;
        private double edgeHeightMetres;

        // Candidates of this frame, up to the capacity; only surfaces that lie side by side need them.
        private readonly ContactCandidate[] considered = new ContactCandidate[16];
        private int consideredCount;
        private ContactCandidate? current;
        private ContactCandidate? deepest;
        private ContactCandidate? first;
        private ContactCandidate? nearest;
        private bool hasContinued;
        private ForceVerdict verdict;
        private ContactStatistics statistics;

        public ContactTracker(double tipRadiusMetres)
        {
            path = new TouchedPath(history);
            TipRadiusMetres = tipRadiusMetres;
        }

        public double TipRadiusMetres
        {
            get => tipRadiusMetres;
            set => tipRadiusMetres = value >= 0.0 && Vectors.IsUsable(value)
                ? value
                : throw new ArgumentOutOfRangeException(nameof(value), "contact: TipRadiusMetres must be 0 or more");
        }

        /// <summary>Finds the closest points of surfaces for other tip positions than this frame's; null to judge
        /// landings and edges by this frame's points alone.</summary>
        public IContactGeometry? Geometry { get; set; }

        /// <summary>Detector of a measured tip force; null where geometry decides.</summary>
        public ForceTouch? Force { get; set; }

        public ContactStatistics Statistics => statistics;

        /// <summary>Centre of the tip in this frame; valid after <see cref="BeginFrame"/> returned true.</summary>
        public Double3 TipMetres => tipMetres ?? Double3.Zero;

        /// <summary>Surfaces farther from the tip's centre than this are ignored.</summary>
        public double ReachMetres => TipRadiusMetres + (verdict == ForceVerdict.Pressed
            ? Force!.ReachMetres
            : ReleaseDistanceMetres);

        /// <summary>The reach for one surface. The touched surface has a longer one, to distinguish a tip that slid off
        /// from one that was lifted.</summary>
        public double ReachMetresOf(ContactBody surface) => ReferenceEquals(surface, touched)
            ? Math.Max(ReachMetres, TipRadiusMetres + ContactTransitions.SlideOffReachMetres)
            : ReachMetres;

        /// <summary>How far a hand may have moved since the last frame: surfaces within this distance may have been
        /// passed, or may be before the next one.</summary>
        public double PassedWithinMetres => double.IsNaN(pathSeconds)
            ? 0.0
            : HandSpeedMps * Vectors.Clamp(nowSeconds - pathSeconds, 0.0, MaximumPathSeconds);

        public double NowSeconds => nowSeconds;

        /// <summary>The surface touched in the last frame; null for none.</summary>
        public ContactBody? Touched => touched;

        /// <summary>Advances the clock, the tip and its history. False without a usable tip position: no surface needs
        /// to be considered, and <see cref="EndFrame"/> returns a reading without touch.</summary>
        /// <remarks>A sample with an unusable position keeps the last position for the lost time. A time that stands
        /// still updates the geometry only. A time that goes backwards, a pause or a jump discards the history: the
        /// velocity is zero until the next frame.</remarks>
        public bool BeginFrame(in TipSample tipSample)
        {
            sample = tipSample;
            current = deepest = first = nearest = null;
            hasContinued = false;
            consideredCount = 0;
            ++statistics.Samples;
            bool timeUsable = Vectors.IsUsable(sample.TimeSeconds);
            bool positionUsable = Vectors.IsUsable(sample.PositionMetres);
            bool forceUsable = !sample.ForceNewtons.HasValue ||
                (Vectors.IsFinite(sample.ForceNewtons.Value) && sample.ForceNewtons.Value >= 0.0);
            if (!timeUsable || !positionUsable || !forceUsable)
            {
                ++statistics.SanitisedSamples;
            }
            double before = nowSeconds;
            pathSeconds = before;
            if (timeUsable)
            {
                nowSeconds = sample.TimeSeconds;
            }
            verdict = Force?.Update(nowSeconds, sample.ForceNewtons) ?? ForceVerdict.Unknown;
            stepSeconds = started ? Vectors.Clamp(nowSeconds - before, 0.0, MaximumFrameSeconds) : 0.0;
            started = started || timeUsable;
            if (positionUsable)
            {
                tipMetres = sample.PositionMetres;
                tipSeconds = nowSeconds;
            }
            else if (tipMetres.HasValue &&
                     (!timeUsable || Math.Abs(nowSeconds - tipSeconds) > LostSeconds))
            {
                tipMetres = null;
                history.Clear();
            }
            if (!tipMetres.HasValue)
            {
                return false;
            }
            AddToHistory(tipMetres.Value);
            return true;
        }

        /// <summary>Advances the clock by a catch-up step of physics in which the tip was not read again, so that the time
        /// until the next frame does not count as a pause.</summary>
        public void Pass(double timeSeconds)
        {
            history.Pass(timeSeconds);
            path.Pass(timeSeconds);
        }

        /// <summary>The face of a surface that holds the tip.</summary>
        /// <remarks>Ask after recording the surface's pose, which tells whether the tip has jumped.</remarks>
        public HeldFace HeldFaceOf(ContactBody surface)
        {
            bool isTouched = ReferenceEquals(touched, surface);
            if (isTouched)
            {
                ContinuePath();
            }
            return new HeldFace(isTouched ? localNormal : null, touched == null || (isTouched && beganHere),
                SwitchMarginMetres, isTouched);
        }

        /// <summary>Where the tip was in the last frame, in the surface's own frame: the motion of the world that both
        /// share is no path. Null for a surface that was not near then, and after a jump of the tip or of the surface.
        /// To be called once a frame for every surface near the tip.</summary>
        public Double3? AdvancePath(ContactBody surface, in RigidPose pose)
        {
            Double3 from = surface.TipMetres;
            Double3 tip = pose.PointToLocal(TipMetres);
            bool isKnown = surface.TipFrame != 0 && surface.TipFrame + 1 == statistics.Samples &&
                !double.IsNaN(pathSeconds);
            double seconds = nowSeconds - pathSeconds;
            double moved = Double3.Distance(from, tip);
            bool isPath = isKnown && !VelocitySettings.IsJump(moved, seconds, surface.TipSpeedMps);
            surface.TipMetres = tip;
            surface.TipSpeedMps = isKnown
                ? moved / Math.Max(seconds, VelocitySettings.MinimumJumpSeconds)
                : double.PositiveInfinity;
            surface.TipFrame = statistics.Samples;
            return isPath ? from : (Double3?)null;
        }

        /// <summary>Adds a surface near the tip. Between equal depths the first is chosen.</summary>
        public void Consider(in ContactCandidate candidate)
        {
            bool isCurrent = ReferenceEquals(candidate.Surface, touched);
            bool isIn = isCurrent || candidate.Local.BeyondMetres <= 0.0;
            if (isIn && consideredCount < considered.Length &&
                candidate.Local.SignedDistanceMetres <= TipRadiusMetres + ReleaseDistanceMetres)
            {
                considered[consideredCount++] = candidate;
            }
            if (isCurrent)
            {
                current = candidate;
            }
            else
            {
                ConsiderOther(candidate, isIn);
            }
            bool isNear = isIn && verdict == ForceVerdict.Pressed && Force!.IsNear(-PenetrationOf(candidate), false);
            if (isNear && (nearest is not { } before || GapOf(candidate) < GapOf(before)))
            {
                nearest = candidate;
            }
        }

        private void ConsiderOther(in ContactCandidate candidate, bool isIn)
        {
            if (isIn && (deepest is not { } other || PenetrationOf(candidate) > PenetrationOf(other)))
            {
                deepest = candidate;
            }
            bool isBefore = first is not { } before || candidate.EntryShare < before.EntryShare ||
                (candidate.EntryShare == before.EntryShare && PenetrationOf(candidate) > PenetrationOf(before));
            if (isBefore && PenetrationOf(candidate) > 0.0)
            {
                first = candidate;
            }
        }

        public ContactReading EndFrame()
        {
            bool wasTouching = touched != null;
            ContinuePath();
            if (!tipMetres.HasValue || !ChooseContact(out ContactCandidate contact))
            {
                CountSlideOff();
                touched = null;
                localNormal = null;
                return Idle();
            }
            if (!ReferenceEquals(touched, contact.Surface))
            {
                ForgetContinuity();
                contact.Surface.Frame.Reset();
                touched = contact.Surface;
                beganHere = !wasTouching;
            }
            return Describe(contact, !wasTouching);
        }

        /// <summary>Ends the touch and discards the tip: the stylus was disabled or teleported.</summary>
        public void Forget()
        {
            touched = null;
            localNormal = null;
            tipMetres = null;
            history.Clear();
            transitions.Forget();
            Force?.Reset();
            verdict = ForceVerdict.Unknown;
        }

        /// <summary>Discards the tip's path: the metre has changed. The touch goes on.</summary>
        public void ForgetPath()
        {
            history.Clear();
            path.Drop();
            ForgetContinuity();
            transitions.Forget();
            pathSeconds = double.NaN;
        }

        /// <summary>Removes a surface that was destroyed, disabled, or whose entry is reused.</summary>
        public void Release(ContactBody surface)
        {
            transitions.Release(surface);
            if (ReferenceEquals(touched, surface))
            {
                touched = null;
                localNormal = null;
            }
        }

        private void AddToHistory(Double3 tip)
        {
            TipStep step = history.Add(nowSeconds, tip);
            statistics.ClockRestarts += step == TipStep.ClockRestarted ? 1UL : 0UL;
            if (step != TipStep.Continued)
            {
                ForgetContinuity();
                transitions.Forget();
                pathSeconds = double.NaN;
            }
        }

        /// <summary>Adds this frame to the path over the surface that was touched in the last frame.</summary>
        private void ContinuePath()
        {
            if (hasContinued)
            {
                return;
            }
            hasContinued = true;
            if (touched == null || !ReferenceEquals(path.Surface, touched) || !tipMetres.HasValue)
            {
                path.Drop();
            }
            else if (path.Continue(nowSeconds, tipMetres.Value) == TipStep.Jumped)
            {
                ++statistics.Teleports;
                ForgetContinuity();
                transitions.Forget();
            }
        }

        private void ForgetContinuity()
        {
            localNormal = null;
            touched?.Frame.Reset();
        }

        private double PenetrationOf(in ContactCandidate candidate) =>
            TipRadiusMetres - candidate.Local.SignedDistanceMetres;

        private double GapOf(in ContactCandidate candidate) => Math.Abs(PenetrationOf(candidate));

        private bool ChooseContact(out ContactCandidate contact)
        {
            switch (verdict)
            {
                case ForceVerdict.Pressed:
                    return ChooseNearest(out contact);
                case ForceVerdict.Lifted:
                    contact = default;
                    return false;
                default:
                    return ChooseDeepest(out contact);
            }
        }

        private bool ChooseNearest(out ContactCandidate contact)
        {
            ContactCandidate? kept = current is { } held && Force!.IsNear(-PenetrationOf(held), true) ? current : null;
            bool isAhead = nearest is { } other && (kept is not { } own ||
                (GapOf(own) - GapOf(other) > SwitchMarginMetres && IsAheadAtRest(own, other)));
            ContactCandidate? chosen = isAhead ? nearest : kept;
            contact = chosen ?? default;
            return chosen.HasValue;
        }

        private bool ChooseDeepest(out ContactCandidate contact)
        {
            if (current is not { } own || PenetrationOf(own) < -ReleaseDistanceMetres || HasLeft(own))
            {
                // A tip that slides from one surface to another touches where it is, not what it passed on the way.
                bool isIn = touched != null && deepest is { } next && PenetrationOf(next) > 0.0;
                ContactCandidate? chosen = isIn ? deepest : first;
                contact = chosen ?? default;
                return chosen.HasValue;
            }
            contact = own;
            if (deepest is not { } below || !IsAhead(own, below))
            {
                return true;
            }
            bool hasNext = false;
            for (int index = 0; index < consideredCount; ++index)
            {
                ContactCandidate other = considered[index];
                bool isDeeper = !hasNext || PenetrationOf(other) > PenetrationOf(contact);
                if (!ReferenceEquals(other.Surface, touched) && IsAhead(own, other) && isDeeper && IsAheadAtRest(own, other))
                {
                    contact = other;
                    hasNext = true;
                }
            }
            return true;
        }

        /// <summary>True where the tip came out of the touched surface's far side. It did not if it is in another
        /// surface that is so near to that side that the tip was never free between the two.</summary>
        private bool HasLeft(in ContactCandidate own)
        {
            double free = TipRadiusMetres + ReleaseDistanceMetres;
            double beyond = own.Local.BeyondMetres;
            if (beyond <= free)
            {
                return false;
            }
            Double3 farSide = TipMetres + own.Pose.DirectionToWorld(own.Local.Normal) * beyond;
            for (int index = 0; index < consideredCount; ++index)
            {
                ContactCandidate other = considered[index];
                if (!ReferenceEquals(other.Surface, touched) && PenetrationOf(other) > 0.0 &&
                    (Geometry == null || (Geometry.TryClosest(other.Surface, farSide, out SurfacePoint next) &&
                        next.SignedDistanceMetres <= TipRadiusMetres + free)))
                {
                    return false;
                }
            }
            return true;
        }

        private bool IsAhead(in ContactCandidate own, in ContactCandidate other) => PenetrationOf(other) > 0.0 &&
            PenetrationOf(other) - PenetrationOf(own) > SwitchMarginMetres;

        /// <summary>True where the tip, moved out of the touched surface until it just rests on it, would touch the other
        /// one.</summary>
        private bool IsAheadAtRest(in ContactCandidate own, in ContactCandidate other)
        {
            double depth = PenetrationOf(own);
            Double3 tip = TipMetres + own.Pose.DirectionToWorld(own.Local.Normal) * Math.Max(0.0, depth);
            return Geometry == null || (Geometry.TryClosest(other.Surface, tip, out SurfacePoint atRest) &&
                TipRadiusMetres - atRest.SignedDistanceMetres - Math.Min(0.0, depth) > SwitchMarginMetres);
        }

        /// <summary>The candidate that a resting tip would touch deepest.</summary>
        private ContactCandidate RestingPlace(in ContactCandidate contact, Double3 restingTip)
        {
            ContactCandidate deepest = contact;
            bool hasOne = false;
            for (int index = 0; index < consideredCount; ++index)
            {
                ContactCandidate each = considered[index];
                if (Geometry!.TryClosest(each.Surface, restingTip, out SurfacePoint local) &&
                    (!hasOne || local.SignedDistanceMetres < deepest.Local.SignedDistanceMetres))
                {
                    deepest = new ContactCandidate(each.Surface, each.Pose, local);
                    hasOne = true;
                }
            }
            return deepest;
        }

        private bool IsCaught(in ContactCandidate contact, Double3 restingTip)
        {
            for (int index = 0; index < consideredCount; ++index)
            {
                ContactCandidate other = considered[index];
                if (!ReferenceEquals(other.Surface, contact.Surface) &&
                    Geometry!.TryClosest(other.Surface, restingTip, out SurfacePoint atRest) &&
                    transitions.IsCaughtBy(new ContactCandidate(other.Surface, other.Pose, atRest), contact, restingTip,
                        TipRadiusMetres, nowSeconds))
                {
                    return true;
                }
            }
            return false;
        }

        private void CountTransition(in ContactCandidate contact, Double3 velocity)
        {
            ContactCandidate place = contact;
            if (Geometry != null && transitions.IsElsewhere(contact, nowSeconds))
            {
                Double3 tip = transitions.RestingTip(contact, TipMetres, TipRadiusMetres, nowSeconds);
                place = RestingPlace(contact, tip);
                bool isElsewhere = !transitions.IsOn(place.Surface);
                // The tip is still on one surface but would rest on the other: the change is counted when the contact
                // changes.
                bool isEarly = isElsewhere && transitions.IsOn(contact.Surface);
                if (isEarly || (!isElsewhere && IsCaught(place, tip)))
                {
                    return;
                }
            }
            double approach = Math.Max(0.0, -Double3.Dot(velocity, place.Pose.DirectionToWorld(place.Local.Normal)));
            (bool landed, double edgeMetres) = transitions.Advance(place, TipRadiusMetres, nowSeconds, approach);
            if (landed)
            {
                ++landingCounter;
                approachSpeedMps = approach;
            }
            CountEdge(edgeMetres);
        }

        /// <summary>Counts the edge of a tip that slid off, while the touched surface is still known. A measured
        /// lift-off takes precedence over geometry.</summary>
        private void CountSlideOff()
        {
            if (current is { } own && tipMetres.HasValue && verdict != ForceVerdict.Lifted && transitions.IsOn(own.Surface) &&
                (Geometry == null || !IsCaught(own, transitions.RestingTip(own, TipMetres, TipRadiusMetres, nowSeconds))))
            {
                double height = verdict == ForceVerdict.Pressed
                    ? Force!.ReachMetres
                    : ReleaseDistanceMetres;
                CountEdge(transitions.SlideOff(own, TipMetres, TipRadiusMetres, nowSeconds, height));
            }
            transitions.Forget();
        }

        private void CountEdge(double heightMetres)
        {
            if (heightMetres > 0.0)
            {
                ++edgeCounter;
                edgeHeightMetres = heightMetres;
            }
        }

        private ContactReading Describe(in ContactCandidate contact, bool touchDown)
        {
            ContactBody surface = contact.Surface;
            Double3 normal = Vectors.UnitOr(contact.Pose.DirectionToWorld(contact.Local.Normal), Double3.Up);
            if (!ReferenceEquals(path.Surface, surface))
            {
                path.Follow(surface);
            }
            TipVelocity found = path.Velocity;
            Double3 velocity = found.NowMps;
            surface.Frame.Update(contact.Local.Normal, stepSeconds);
            localNormal = contact.Local.Normal;
            if (touchDown)
            {
                ++touchCounter;
                ++statistics.TouchDowns;
                approachSpeedMps = Math.Max(0.0, -Double3.Dot(found.ApproachMps, normal));
                transitions.Forget();
            }
            CountTransition(contact, found.ApproachMps);

            ContactReading reading = Idle();
            reading.State.Touching = true;
            reading.Surface = surface;
            reading.PointMetres = contact.Pose.PointToWorld(contact.Local.PointMetres);
            reading.Normal = normal;
            reading.PenetrationMetres = Math.Max(0.0, PenetrationOf(contact));
            reading.FirstAxis = contact.Pose.DirectionToWorld(surface.Frame.First);
            reading.SecondAxis = contact.Pose.DirectionToWorld(surface.Frame.Second);
            reading.State.FirstVelocityMps = (float)Double3.Dot(velocity, reading.FirstAxis);
            reading.State.SecondVelocityMps = (float)Double3.Dot(velocity, reading.SecondAxis);
            reading.State.ApproachSpeedMps = (float)approachSpeedMps;
            reading.State.ForceNewtons = (float)ForceOf(surface, reading.PenetrationMetres);
            reading.State.HasPlace = true;
            reading.State.SurfaceSeed = surface.Seed;
            reading.State.PlaceMetres = new PlaceVector(contact.Local.PointMetres);
            reading.State.FirstAxis = new PlaceVector(surface.Frame.First);
            reading.State.SecondAxis = new PlaceVector(surface.Frame.Second);
            return reading;
        }

        private double ForceOf(ContactBody surface, double penetrationMetres)
        {
            double own = surface.StiffnessNewtonsPerMetre;
            double stiffness = own > 0.0 && Vectors.IsUsable(own)
                ? own
                : DefaultStiffnessNewtonsPerMetre;
            double? measured = verdict == ForceVerdict.Pressed ? Force!.ForceNewtons : sample.ForceNewtons;
            double force = measured.HasValue && Vectors.IsFinite(measured.Value)
                ? measured.Value
                : stiffness * penetrationMetres;
            return Vectors.Clamp(force, 0.0, MaximumForceNewtons);
        }

        private ContactReading Idle()
        {
            return new ContactReading
            {
                TimeSeconds = nowSeconds,
                State = new ContactState
                {
                    TouchCounter = touchCounter,
                    LandingCounter = landingCounter,
                    EdgeCounter = edgeCounter,
                    EdgeHeightMetres = (float)edgeHeightMetres,
                },
                PointMetres = TipMetres,
                Normal = Double3.Up,
            };
        }
    }
}
