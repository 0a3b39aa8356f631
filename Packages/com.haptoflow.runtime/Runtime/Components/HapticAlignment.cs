#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Alignment;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Puts this object onto a real one: the pen touches three marked points of the real object, and this one
    /// moves there.</summary>
    /// <remarks>A pen that measures its tip force takes each point by resting on it; for others,
    /// <see cref="TakePoint"/> is called where the tip is. The pose is kept under <see cref="SaveName"/> and relative
    /// to the parent: it holds as long as the tracking space stays where it was.</remarks>
    [AddComponentMenu("HaptoFlow/Haptic Alignment")]
    [HelpURL(HelpPages.Components + "haptic-alignment")]
    [DefaultExecutionOrder(1100)]
    [DisallowMultipleComponent]
    public sealed class HapticAlignment : MonoBehaviour
    {
        private const int PointCount = 3;

        [SerializeField, Tooltip("The pen that touches the real object.")]
        private HapticStylus? stylus;

        [SerializeField, Tooltip("Three points of this object that can be found on the real one, in local space and " +
            "in the order in which they are touched. Different distances between them tell a wrong order.")]
        private Vector3[] marks =
        {
            new Vector3(-0.1f, 0f, -0.075f), new Vector3(0.1f, 0f, -0.075f), new Vector3(-0.1f, 0f, 0.075f),
        };

        [SerializeField, Tooltip("Out of the object at the marks, in local space: the side that the pen touches.")]
        private Vector3 outward = new Vector3(0f, 1f, 0f);

        [SerializeField, Tooltip("The pose is kept between sessions under this name; empty to keep nothing.")]
        private string saveName = "";

        private readonly List<Double3> touched = new List<Double3>(PointCount);
        private readonly TouchedPoint rest = new TouchedPoint();
        private ForceTouch? force;
        private RigidPose? poseBefore;
        private bool wasAligned;

        /// <summary>Something of what this component shows changed. Main thread.</summary>
        public event Action<HapticAlignment>? Changed;

        /// <summary>The pen that touches the real object.</summary>
        public HapticStylus? Stylus
        {
            get => stylus;
            set => stylus = value;
        }

        /// <summary>Three points in local space, in the order in which they are touched.</summary>
        public IReadOnlyList<Vector3> Marks => marks;

        /// <summary>Out of the object at the marks, in local space.</summary>
        public Vector3 Outward
        {
            get => outward;
            set => outward = value;
        }

        /// <summary>The pose is kept under this name and restored when the component starts; empty for neither.
        /// </summary>
        public string SaveName
        {
            get => saveName;
            set => saveName = value ?? "";
        }

        /// <summary>Points are being taken.</summary>
        public bool IsTaking { get; private set; }

        /// <summary>The object is where three touches put it, in this session or in the one that kept its pose.
        /// </summary>
        public bool IsAligned { get; private set; }

        /// <summary>0 to 3.</summary>
        public int PointsTaken => touched.Count;

        /// <summary>The last alignment's largest distance between a mark and where it was touched, in metres.</summary>
        public float ErrorMetres { get; private set; }

        /// <summary>What to do next, or what came of it: one line for the user.</summary>
        public string Message { get; private set; } = "";

        /// <summary>Chooses the points to touch.</summary>
        /// <exception cref="ArgumentException">They give no pose; the message says why.</exception>
        public void SetMarks(Vector3 first, Vector3 second, Vector3 third)
        {
            var chosen = new[] { first, second, third };
            string? problem = ThreePointFit.WhyMarksUnusable(InMetres(chosen));
            if (problem != null)
            {
                throw new ArgumentException("HaptoFlow: " + problem);
            }
            marks = chosen;
        }

        /// <summary>Starts taking points, from the first.</summary>
        public void Begin()
        {
            touched.Clear();
            rest.AwaitLift();
            force = stylus != null ? stylus.ForceDecision.NewTouch() : null;
            IsTaking = true;
            Tell(WhatNext());
        }

        /// <summary>Takes the place where the tip is now as the next point.</summary>
        /// <exception cref="InvalidOperationException">No points are being taken, or there is no stylus.</exception>
        public void TakePoint()
        {
            if (!IsTaking || stylus == null)
            {
                throw new InvalidOperationException("HaptoFlow: " + (IsTaking
                    ? "the alignment has no stylus"
                    : "a point is taken after Begin"));
            }
            Take(stylus.TipPosition.ToDouble());
        }

        /// <summary>While points are taken: forgets the last one, or stops where there is none. Afterwards: puts the
        /// object back where it was before the last alignment.</summary>
        public void Undo()
        {
            if (IsTaking && touched.Count > 0)
            {
                touched.RemoveAt(touched.Count - 1);
                Tell(WhatNext());
            }
            else if (IsTaking)
            {
                Cancel();
            }
            else if (poseBefore.HasValue)
            {
                MoveTo(poseBefore.Value);
                poseBefore = null;
                IsAligned = wasAligned;
                KeepOrForget();
                Tell("The object is back where it was.");
            }
        }

        /// <summary>Stops taking points; the object stays where it is.</summary>
        public void Cancel()
        {
            if (IsTaking)
            {
                IsTaking = false;
                touched.Clear();
                Tell("The object stays where it was.");
            }
        }

        /// <summary>Deletes the kept pose; the object stays where it is.</summary>
        public void ForgetSaved()
        {
            if (saveName.Length > 0)
            {
                new AlignmentFile(saveName).Delete(this);
            }
        }

        /// <summary>Where a mark is now, in world space.</summary>
        /// <param name="index">0 to 2.</param>
        public Vector3 MarkPosition(int index) => transform.TransformPoint(marks[index]);

        private void Start()
        {
            if (saveName.Length > 0 && new AlignmentFile(saveName).TryRead(out RigidPose saved, this))
            {
                poseBefore = LocalPose();
                MoveTo(saved);
                IsAligned = true;
                Tell("The object is where it was aligned last.");
            }
        }

        private void OnDisable() => Cancel();

        private void LateUpdate()
        {
            if (!IsTaking || stylus == null || force == null)
            {
                return;
            }
            double nowSeconds = Time.unscaledTimeAsDouble;
            TipForceSource? source = stylus.Force;
            float newtons = 0f;
            bool measures = source != null && source.isActiveAndEnabled && source.TryMeasure(out newtons);
            bool pressed = force.Update(nowSeconds, measures ? newtons : (double?)null) == ForceVerdict.Pressed;
            if (rest.Update(nowSeconds, stylus.TipPosition.ToDouble(), pressed, out Double3 place))
            {
                Take(place);
            }
        }

        private void Take(Double3 place)
        {
            touched.Add(place);
            if (touched.Count < PointCount)
            {
                Tell(WhatNext());
                return;
            }
            AlignmentFit fit = ThreePointFit.Solve(
                InMetres(marks), touched, outward.ToDouble(), stylus!.TipRadiusMetres);
            touched.Clear();
            if (fit.Refusal != null)
            {
                Tell($"Not aligned: {fit.Refusal}.");
                return;
            }
            IsTaking = false;
            ErrorMetres = (float)fit.LargestErrorMetres;
            poseBefore = LocalPose();
            wasAligned = IsAligned;
            IsAligned = true;
            transform.SetPositionAndRotation(fit.Pose.PositionMetres.ToVector(), ToQuaternion(fit.Pose.Rotation));
            ForgetMotion();
            KeepOrForget();
            Tell(FormattableString.Invariant($"Aligned; {1000f * ErrorMetres:0.0} mm are left at the worst mark."));
        }

        private string WhatNext() => stylus == null
            ? "The alignment has no stylus."
            : stylus.Force != null
                ? $"Rest the pen on mark {touched.Count + 1} of {PointCount}, still, then lift it."
                : $"Put the tip on mark {touched.Count + 1} of {PointCount} and take the point.";

        private Double3[] InMetres(Vector3[] local)
        {
            Vector3 scale = transform.lossyScale;
            return Array.ConvertAll(local, point => Vector3.Scale(scale, point).ToDouble());
        }

        private RigidPose LocalPose() => Conversions.PoseOf(transform.localPosition, transform.localRotation);

        private void MoveTo(in RigidPose local)
        {
            transform.localPosition = local.PositionMetres.ToVector();
            transform.localRotation = ToQuaternion(local.Rotation);
            ForgetMotion();
        }

        // The object was not moved by anybody's hand: its jump must not be felt as speed.
        private static void ForgetMotion()
        {
            foreach (HapticStylus each in FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None))
            {
                each.ForgetMotion();
            }
        }

        /// <summary>An object that nobody aligned is where its author put it, in the next session too.</summary>
        private void KeepOrForget()
        {
            if (!IsAligned)
            {
                ForgetSaved();
            }
            else if (saveName.Length > 0)
            {
                new AlignmentFile(saveName).Write(LocalPose(), this);
            }
        }

        private void Tell(string message)
        {
            Message = message;
            Changed?.Invoke(this);
        }

        private static Quaternion ToQuaternion(in Rotation rotation) =>
            new Quaternion((float)rotation.X, (float)rotation.Y, (float)rotation.Z, (float)rotation.W);
    }
}
