#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using HaptoFlow.Alignment;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Moves this object onto a real one after the pen has touched three marked points of the real
    /// object.</summary>
    /// <remarks>With a pen that measures its tip force, resting on a mark takes the point; with other pens, call <see
    /// cref="TakePoint"/> while the tip is on the mark. The pose is saved under <see cref="SaveName"/>, relative to the
    /// parent: it stays valid as long as the tracking space does.</remarks>
    [AddComponentMenu("HaptoFlow/Haptic Alignment")]
    [HelpPage(HelpPages.Components + "haptic-alignment")]
    [DefaultExecutionOrder(1100)]
    [DisallowMultipleComponent]
    public sealed class HapticAlignment : MonoBehaviour
    {
        private const int PointCount = 3;

        [SerializeField, Tooltip("The pen that touches the real object.")]
        private HapticStylus? stylus;

        [SerializeField, Tooltip("Three points of this object that can be found on the real one, in local space, in " +
            "the order in which the pen touches them. Unequal distances let the alignment detect a wrong order.")]
        private Vector3[] marks =
        {
            new Vector3(-0.1f, 0f, -0.075f), new Vector3(0.1f, 0f, -0.075f), new Vector3(-0.1f, 0f, 0.075f),
        };

        [SerializeField, Tooltip("The direction out of the object at the marks, in local space: the side that the " +
            "pen touches.")]
        private Vector3 outward = new Vector3(0f, 1f, 0f);

        [SerializeField, Tooltip("The name under which the pose is saved between sessions. Leave it empty to save " +
            "nothing.")]
        private string saveName = "";

        private readonly List<Double3> touched = new List<Double3>(PointCount);
        private readonly TouchedPoint restingPoint = new TouchedPoint();
        private ForceTouch? pressDetector;
        private RigidPose? poseBefore;
        private bool wasAligned;

        /// <summary>Raised when <see cref="Message"/> or another property of this component changed. Main
        /// thread.</summary>
        public event Action<HapticAlignment>? Changed;

        /// <summary>The pen that touches the real object.</summary>
        public HapticStylus? Stylus { get => stylus; set => stylus = value; }

        /// <summary>Three points in local space, in the order in which they are touched.</summary>
        public IReadOnlyList<Vector3> Marks => marks;

        /// <summary>Direction out of the object at the marks, in local space.</summary>
        public Vector3 Outward { get => outward; set => outward = value; }

        /// <summary>Name under which the pose is saved; it is restored when the component starts. Empty to save
        /// nothing.</summary>
        public string SaveName { get => saveName; set => saveName = value ?? ""; }

        /// <summary>True between <see cref="Begin"/> and the third point.</summary>
        public bool IsTaking { get; private set; }

        /// <summary>True after three points aligned the object, in this session or in the one that saved the
        /// pose.</summary>
        public bool IsAligned { get; private set; }

        /// <summary>Points taken so far, 0 to 3.</summary>
        public int PointsTaken => touched.Count;

        /// <summary>The largest distance between a mark and the place where it was touched, in metres, of the last
        /// alignment.</summary>
        public float ErrorMetres { get; private set; }

        /// <summary>One line for the user: what to do next, or the result.</summary>
        public string Message { get; private set; } = "";

        /// <summary>Sets the points to touch.</summary>
        /// <exception cref="ArgumentException">The points do not determine a pose; the message says why.</exception>
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

        /// <summary>Starts taking points, beginning with the first.</summary>
        public void Begin()
        {
            touched.Clear();
            restingPoint.AwaitLift();
            pressDetector = stylus != null ? stylus.ForceDecision.NewDetector() : null;
            IsTaking = true;
            ShowMessage(NextInstruction());
        }

        /// <summary>Takes the present position of the tip as the next point.</summary>
        /// <exception cref="InvalidOperationException">No points are being taken, or there is no stylus.</exception>
        public void TakePoint()
        {
            if (!IsTaking || stylus == null)
            {
                throw new InvalidOperationException("HaptoFlow: " + (IsTaking
                    ? "the alignment has no stylus"
                    : "call Begin before TakePoint"));
            }
            Take(stylus.TipPosition.ToDouble());
        }

        /// <summary>While points are being taken: discards the last one, or cancels where there is none. Afterwards:
        /// restores the pose before the last alignment.</summary>
        public void Undo()
        {
            if (IsTaking && touched.Count > 0)
            {
                touched.RemoveAt(touched.Count - 1);
                ShowMessage(NextInstruction());
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
                // One that is back at its author's pose has nothing to keep.
                Save(IsAligned ? LocalPose() : (RigidPose?)null);
                ShowMessage("The object is back where it was.");
            }
        }

        /// <summary>Stops taking points; the object stays where it is.</summary>
        public void Cancel()
        {
            if (IsTaking)
            {
                IsTaking = false;
                touched.Clear();
                ShowMessage("The object stays where it was.");
            }
        }

        /// <summary>Deletes the saved pose; the object stays where it is.</summary>
        public void ForgetSaved() => Save(null);

        /// <summary>Present position of a mark, in world space.</summary>
        /// <param name="index">0 to 2.</param>
        public Vector3 MarkPosition(int index) => transform.TransformPoint(marks[index]);

        private void Start()
        {
            if (saveName.Length > 0 && new AlignmentFile(saveName).TryRead(out RigidPose saved, this))
            {
                poseBefore = LocalPose();
                MoveTo(saved);
                IsAligned = true;
                ShowMessage("The object is at the pose of the last alignment.");
            }
        }

        private void OnDisable() => Cancel();

        private void LateUpdate()
        {
            if (!IsTaking || stylus == null || pressDetector == null)
            {
                return;
            }
            double nowSeconds = Time.unscaledTimeAsDouble;
            TipForceSource? source = stylus.Force;
            float newtons = 0f;
            bool measures = source != null && source.isActiveAndEnabled && source.TryMeasure(out newtons);
            bool pressed = pressDetector.Update(nowSeconds, measures ? newtons : (double?)null) == ForceVerdict.Pressed;
            if (restingPoint.Update(nowSeconds, stylus.TipPosition.ToDouble(), pressed, out Double3 place))
            {
                Take(place);
            }
        }

        private void Take(Double3 place)
        {
            touched.Add(place);
            if (touched.Count < PointCount)
            {
                ShowMessage(NextInstruction());
                return;
            }
            AlignmentFit fit = ThreePointFit.Solve(
                InMetres(marks), touched, outward.ToDouble(), stylus!.TipRadiusMetres);
            touched.Clear();
            if (fit.Refusal != null)
            {
                ShowMessage($"Not aligned: {fit.Refusal}.");
                return;
            }
            IsTaking = false;
            ErrorMetres = (float)fit.LargestErrorMetres;
            poseBefore = LocalPose();
            wasAligned = IsAligned;
            IsAligned = true;
            transform.SetPositionAndRotation(fit.Pose.PositionMetres.ToVector(), ToQuaternion(fit.Pose.Rotation));
            ForgetMotion();
            Save(LocalPose());
            string error = (1000f * ErrorMetres).ToString("0.0", CultureInfo.InvariantCulture);
            ShowMessage($"Aligned; {error} mm of error at the worst mark.");
        }

        private string NextInstruction() => stylus == null
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

        // The object jumped without being moved by hand: the styluses must not take the jump for speed.
        private static void ForgetMotion()
        {
            foreach (HapticStylus each in FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None))
            {
                each.ForgetMotion();
            }
        }

        private void Save(RigidPose? pose)
        {
            if (saveName.Length > 0)
            {
                new AlignmentFile(saveName).Save(pose, this);
            }
        }

        private void ShowMessage(string message)
        {
            Message = message;
            Changed?.Invoke(this);
        }

        private static Quaternion ToQuaternion(in Rotation rotation) =>
            new Quaternion((float)rotation.X, (float)rotation.Y, (float)rotation.Z, (float)rotation.W);
    }

    /// <summary>The file in the player's persistent folder that keeps an alignment between sessions. Main
    /// thread.</summary>
    internal readonly struct AlignmentFile
    {
        private readonly string path;

        /// <param name="name">Name of the alignment. Characters other than letters, digits and hyphens become
        /// underscores.</param>
        public AlignmentFile(string name)
        {
            char[] letters = name.ToCharArray();
            for (int index = 0; index < letters.Length; ++index)
            {
                bool plain = char.IsLetterOrDigit(letters[index]) || letters[index] == '-';
                letters[index] = plain ? letters[index] : '_';
            }
            path = Path.Combine(Application.persistentDataPath, "HaptoFlow", new string(letters) + ".pose.json");
        }

        public bool TryRead(out RigidPose pose, UnityEngine.Object context)
        {
            bool found = SavedPose.TryRead(path, out pose, out string? problem);
            if (problem != null)
            {
                Debug.LogWarning($"HaptoFlow: {problem}.", context);
            }
            return found;
        }

        /// <summary>Writes the pose; null deletes the file.</summary>
        public void Save(RigidPose? pose, UnityEngine.Object context)
        {
            try
            {
                if (pose.HasValue)
                {
                    SavedPose.Write(path, pose.Value);
                }
                else
                {
                    File.Delete(path);
                }
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Debug.LogWarning($"HaptoFlow: {path}: {error.Message}; " + (pose.HasValue
                    ? "the alignment is lost when the application ends; make the folder writable to keep it."
                    : "delete the file by hand."), context);
            }
        }
    }
}
