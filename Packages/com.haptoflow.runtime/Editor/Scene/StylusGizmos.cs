#nullable enable
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the tip of a stylus, and its contact while it touches: a cross at its point, normal, tangential
    /// velocity, penetration.</summary>
    internal static class StylusGizmos
    {
        private const float NormalMetres = 0.02f;
        private const float CrossMetres = 0.002f;

        // The length of the velocity arrow is the distance covered in this time, one segment.
        private const float VelocitySeconds = 0.1f;
        private const float MinimumMps = 1e-3f;
        private const float HeadShare = 0.2f;

        private static readonly Color TipColour = new Color(0.95f, 0.95f, 0.95f, 0.8f);
        private static readonly Color PointColour = new Color(1f, 0.85f, 0.2f);
        private static readonly Color NormalColour = new Color(0.35f, 0.75f, 1f);
        private static readonly Color VelocityColour = new Color(0.4f, 0.95f, 0.45f);
        private static readonly Color PenetrationColour = new Color(1f, 0.4f, 0.3f);

        [DrawGizmo(GizmoType.Selected | GizmoType.NonSelected)]
        internal static void Draw(HapticStylus stylus, GizmoType type)
        {
            bool isSelected = (type & GizmoType.Selected) != 0;
            if (isSelected)
            {
                Transform tip = stylus.Tip != null ? stylus.Tip : stylus.transform;
                Gizmos.color = TipColour;
                Gizmos.DrawWireSphere(tip.position, stylus.TipRadiusMetres);
            }
            if (stylus.IsTouching && stylus.isActiveAndEnabled)
            {
                DrawContact(stylus.Contact, isSelected);
            }
            ReliefGizmos.Draw(stylus, isSelected);
        }

        private static void DrawContact(in HapticContact contact, bool withCaption)
        {
            Vector3 point = contact.Point;
            Vector3 velocity = contact.TangentialVelocity;
            Gizmos.color = PointColour;
            Gizmos.DrawLine(point - CrossMetres * contact.FirstAxis, point + CrossMetres * contact.FirstAxis);
            Gizmos.DrawLine(point - CrossMetres * contact.SecondAxis, point + CrossMetres * contact.SecondAxis);
            DrawArrow(NormalColour, point, NormalMetres * contact.Normal, contact.FirstAxis);
            if (velocity.magnitude >= MinimumMps)
            {
                DrawArrow(VelocityColour, point, VelocitySeconds * velocity,
                    Vector3.Cross(contact.Normal, velocity.normalized));
            }
            Gizmos.color = PenetrationColour;
            Gizmos.DrawLine(point, point - contact.PenetrationMetres * contact.Normal);
            if (withCaption)
            {
                Handles.Label(point + NormalMetres * contact.Normal, string.Format(CultureInfo.InvariantCulture,
                    "{0}: {1:0.00} N, {2:0} mm/s, {3:0.0} mm deep", MaterialWords.Of(contact), contact.ForceNewtons,
                    1000f * velocity.magnitude, 1000f * contact.PenetrationMetres));
            }
        }

        /// <param name="side">A vector of unit length across the arrow.</param>
        private static void DrawArrow(Color colour, Vector3 from, Vector3 shaft, Vector3 side)
        {
            Vector3 tip = from + shaft;
            Vector3 back = tip - HeadShare * shaft;
            Vector3 aside = 0.5f * HeadShare * shaft.magnitude * side;
            Gizmos.color = colour;
            Gizmos.DrawLine(from, tip);
            Gizmos.DrawLine(tip, back + aside);
            Gizmos.DrawLine(tip, back - aside);
        }
    }
}
