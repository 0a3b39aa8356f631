#nullable enable
using System.Collections.Generic;
using System.Globalization;
using HaptoFlow.Numerics;
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

    /// <summary>The meaning of a line in the drawing of a contact.</summary>
    internal enum MarkKind
    {
        Point,
        Normal,
        Velocity,
        Penetration,
    }

    /// <summary>A line in world space, in metres.</summary>
    internal sealed record MarkLine(MarkKind Kind, Double3 From, Double3 To);

    /// <summary>The values of a contact that are drawn.</summary>
    internal struct MarkedContact
    {
        public Double3 PointMetres;

        /// <summary>The surface normal, of unit length.</summary>
        public Double3 Normal;

        /// <summary>A tangent of unit length.</summary>
        public Double3 FirstAxis;

        /// <summary>A tangent of unit length.</summary>
        public Double3 SecondAxis;

        public Double3 TangentialVelocityMps;
        public double PenetrationMetres;
        public double ForceNewtons;
    }

    /// <summary>A contact as lines: a cross at its point, normal, tangential velocity, penetration.</summary>
    internal static class ContactMarks
    {
        /// <summary>The length of the velocity arrow is the distance covered in this time, one segment.</summary>
        public const double VelocitySeconds = 0.1;

        public const double NormalMetres = 0.02;
        private const double CrossMetres = 0.002;
        private const double HeadShare = 0.2;
        private const double MinimumMps = 1e-3;

        public static IReadOnlyList<MarkLine> Of(in MarkedContact contact)
        {
            var lines = new List<MarkLine>();
            Double3 first = contact.FirstAxis * CrossMetres;
            Double3 second = contact.SecondAxis * CrossMetres;
            Double3 point = contact.PointMetres;
            lines.Add(new MarkLine(MarkKind.Point, point - first, point + first));
            lines.Add(new MarkLine(MarkKind.Point, point - second, point + second));
            AddArrow(lines, MarkKind.Normal, point, contact.Normal * NormalMetres, contact.FirstAxis);
            if (contact.TangentialVelocityMps.Length >= MinimumMps)
            {
                Double3 displacement = contact.TangentialVelocityMps * VelocitySeconds;
                AddArrow(lines, MarkKind.Velocity, point, displacement,
                    Double3.Cross(contact.Normal, displacement / displacement.Length));
            }
            lines.Add(new MarkLine(
                MarkKind.Penetration, point, point - contact.Normal * contact.PenetrationMetres));
            return lines;
        }

        /// <summary>For example "0.42 N, 150 mm/s, 0.8 mm deep".</summary>
        public static string Caption(in MarkedContact contact) => string.Format(
            CultureInfo.InvariantCulture, "{0:0.00} N, {1:0} mm/s, {2:0.0} mm deep", contact.ForceNewtons,
            1000.0 * contact.TangentialVelocityMps.Length, 1000.0 * contact.PenetrationMetres);

        /// <param name="side">A vector of unit length across the arrow.</param>
        private static void AddArrow(List<MarkLine> lines, MarkKind kind, Double3 from, Double3 shaft, Double3 side)
        {
            Double3 tip = from + shaft;
            Double3 back = shaft * HeadShare;
            Double3 aside = side * (0.5 * HeadShare * shaft.Length);
            lines.Add(new MarkLine(kind, from, tip));
            lines.Add(new MarkLine(kind, tip, tip - back + aside));
            lines.Add(new MarkLine(kind, tip, tip - back - aside));
        }
    }
}
