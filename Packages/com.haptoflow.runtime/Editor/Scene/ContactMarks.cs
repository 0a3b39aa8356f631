#nullable enable
using System.Collections.Generic;
using System.Globalization;
using HaptoFlow.Numerics;

namespace HaptoFlow.Editor
{
    /// <summary>What a line of the contact's drawing means.</summary>
    internal enum MarkKind
    {
        Point,
        Normal,
        Velocity,
        Penetration,
    }

    /// <summary>A line in world space, in metres.</summary>
    internal readonly struct MarkLine
    {
        public MarkLine(MarkKind kind, Double3 from, Double3 to)
        {
            Kind = kind;
            From = from;
            To = to;
        }

        public MarkKind Kind { get; }

        public Double3 From { get; }

        public Double3 To { get; }
    }

    /// <summary>What is drawn of a contact.</summary>
    internal struct MarkedContact
    {
        public Double3 PointMetres;

        /// <summary>Unit length, out of the surface.</summary>
        public Double3 Normal;

        /// <summary>Unit length, along the surface.</summary>
        public Double3 FirstAxis;

        /// <summary>Unit length, along the surface.</summary>
        public Double3 SecondAxis;

        public Double3 TangentialVelocityMps;
        public double PenetrationMetres;
        public double ForceNewtons;
    }

    /// <summary>A contact as lines: a cross at the contact point, the normal, the tangential velocity, the penetration.
    /// </summary>
    internal static class ContactMarks
    {
        /// <summary>The velocity's arrow is the way of one segment.</summary>
        public const double VelocitySeconds = 0.1;

        public const double NormalMetres = 0.02;
        private const double CrossMetres = 0.002;
        private const double HeadShare = 0.2;
        private const double SlowestMps = 1e-3;

        public static IReadOnlyList<MarkLine> Of(in MarkedContact contact)
        {
            var lines = new List<MarkLine>();
            Double3 first = contact.FirstAxis * CrossMetres;
            Double3 second = contact.SecondAxis * CrossMetres;
            Double3 point = contact.PointMetres;
            lines.Add(new MarkLine(MarkKind.Point, point - first, point + first));
            lines.Add(new MarkLine(MarkKind.Point, point - second, point + second));
            AddArrow(lines, MarkKind.Normal, point, contact.Normal * NormalMetres, contact.FirstAxis);
            if (contact.TangentialVelocityMps.Length >= SlowestMps)
            {
                Double3 way = contact.TangentialVelocityMps * VelocitySeconds;
                AddArrow(lines, MarkKind.Velocity, point, way, Double3.Cross(contact.Normal, way / way.Length));
            }
            lines.Add(new MarkLine(
                MarkKind.Penetration, point, point - contact.Normal * contact.PenetrationMetres));
            return lines;
        }

        /// <summary>For example "0.42 N, 150 mm/s, 0.8 mm deep".</summary>
        public static string Caption(in MarkedContact contact) => string.Format(
            CultureInfo.InvariantCulture, "{0:0.00} N, {1:0} mm/s, {2:0.0} mm deep", contact.ForceNewtons,
            1000.0 * contact.TangentialVelocityMps.Length, 1000.0 * contact.PenetrationMetres);

        /// <param name="side">Unit length, across the arrow.</param>
        private static void AddArrow(List<MarkLine> lines, MarkKind kind, Double3 from, Double3 way, Double3 side)
        {
            Double3 tip = from + way;
            Double3 back = way * HeadShare;
            Double3 aside = side * (0.5 * HeadShare * way.Length);
            lines.Add(new MarkLine(kind, from, tip));
            lines.Add(new MarkLine(kind, tip, tip - back + aside));
            lines.Add(new MarkLine(kind, tip, tip - back - aside));
        }
    }
}
