#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes three corners of a horizontal rectangle the marks of a <see cref="HapticAlignment"/>, and shows a
    /// red ball at the corner that the pen has to touch next.</summary>
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "corner-marks")]
    public sealed class CornerMarks : MonoBehaviour
    {
        private static readonly string[] CornerNames = { "near left", "near right", "far left" };
        private static readonly Vector3 BallSize = new Vector3(0.008f, 0.008f, 0.008f);
        private static readonly Color Red = new Color(0.95f, 0.2f, 0.2f);

        private readonly GameObject[] balls = new GameObject[CornerNames.Length];
        private HapticAlignment alignment = null!;

        /// <summary>The name of the corner that has to be touched next, for example "near left". Read it only while the
        /// alignment takes points.</summary>
        public string NextCorner => CornerNames[alignment.PointsTaken];

        /// <summary>Sets the alignment's marks and adds balls below its object. Main thread, in play mode.</summary>
        /// <param name="nearLeft">The near left corner, in the alignment's local space.</param>
        /// <param name="widthMetres">The rectangle's extent along the local x axis.</param>
        /// <param name="depthMetres">The rectangle's extent along the local z axis.</param>
        public static CornerMarks Create(
            HapticAlignment alignment, Vector3 nearLeft, float widthMetres, float depthMetres)
        {
            alignment.SetMarks(
                nearLeft, nearLeft + widthMetres * Vector3.right, nearLeft + depthMetres * Vector3.forward);
            var marks = alignment.gameObject.AddComponent<CornerMarks>();
            marks.alignment = alignment;
            for (int index = 0; index < marks.balls.Length; ++index)
            {
                GameObject ball = SceneObjects.AddMark("Mark " + CornerNames[index], PrimitiveType.Sphere,
                    alignment.MarkPosition(index), BallSize, Red);
                ball.transform.SetParent(marks.transform, true);
                ball.SetActive(false);
                marks.balls[index] = ball;
            }
            alignment.Changed += marks.ShowNext;
            return marks;
        }

        private void OnDestroy()
        {
            if (alignment is { } subscribed)
            {
                subscribed.Changed -= ShowNext;
            }
        }

        private void ShowNext(HapticAlignment changed)
        {
            for (int index = 0; index < balls.Length; ++index)
            {
                balls[index].SetActive(changed.IsTaking && index == changed.PointsTaken);
            }
        }
    }
}
