#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the tip of a stylus, and its contact while it touches.</summary>
    internal static class StylusGizmos
    {
        private static readonly Color TipColour = new Color(0.95f, 0.95f, 0.95f, 0.8f);
        private static readonly Color PointColour = new Color(1f, 0.85f, 0.2f);
        private static readonly Color NormalColour = new Color(0.35f, 0.75f, 1f);
        private static readonly Color VelocityColour = new Color(0.4f, 0.95f, 0.45f);
        private static readonly Color PenetrationColour = new Color(1f, 0.4f, 0.3f);

        [DrawGizmo(GizmoType.Selected | GizmoType.NonSelected)]
        internal static void Draw(HapticStylus stylus, GizmoType type)
        {
            if ((type & GizmoType.Selected) != 0)
            {
                Transform tip = stylus.Tip != null ? stylus.Tip : stylus.transform;
                Gizmos.color = TipColour;
                Gizmos.DrawWireSphere(tip.position, stylus.TipRadiusMetres);
            }
            if (stylus.IsTouching && stylus.isActiveAndEnabled)
            {
                DrawContact(stylus.Contact, (type & GizmoType.Selected) != 0);
            }
        }

        private static void DrawContact(in HapticContact contact, bool withCaption)
        {
            MarkedContact marked = MarkedOf(contact);
            foreach (MarkLine line in ContactMarks.Of(marked))
            {
                Gizmos.color = ColourOf(line.Kind);
                Gizmos.DrawLine(line.From.ToVector(), line.To.ToVector());
            }
            if (withCaption)
            {
                Handles.Label((marked.PointMetres + marked.Normal * ContactMarks.NormalMetres).ToVector(),
                    MaterialWords.Of(contact) + ": " + ContactMarks.Caption(marked));
            }
        }

        private static MarkedContact MarkedOf(in HapticContact contact) => new MarkedContact
        {
            PointMetres = contact.Point.ToDouble(),
            Normal = contact.Normal.ToDouble(),
            FirstAxis = contact.FirstAxis.ToDouble(),
            SecondAxis = contact.SecondAxis.ToDouble(),
            TangentialVelocityMps = contact.TangentialVelocity.ToDouble(),
            PenetrationMetres = contact.PenetrationMetres,
            ForceNewtons = contact.ForceNewtons,
        };

        private static Color ColourOf(MarkKind kind) => kind switch
        {
            MarkKind.Normal => NormalColour,
            MarkKind.Velocity => VelocityColour,
            MarkKind.Penetration => PenetrationColour,
            _ => PointColour,
        };
    }
}
