using HaptoFlow.Numerics;

namespace HaptoFlow.RepositoryTests
{
    internal static class TriangleGeometry
    {
        /// <summary>The point of a triangle nearest to another point, and the feature that it lies on: a corner (0 to
        /// 2), an edge (3: a-b, 4: b-c, 5: c-a) or the face (6). Found by the Voronoi regions of the features (Ericson,
        /// Real-Time Collision Detection, 5.1.5).</summary>
        public static (Double3 Place, int Feature) Closest(Double3 a, Double3 b, Double3 c, Double3 point)
        {
            Double3 ab = b - a;
            Double3 ac = c - a;
            double abA = Double3.Dot(ab, point - a);
            double acA = Double3.Dot(ac, point - a);
            if (abA <= 0.0 && acA <= 0.0)
            {
                return (a, 0);
            }
            double abB = Double3.Dot(ab, point - b);
            double acB = Double3.Dot(ac, point - b);
            if (abB >= 0.0 && acB <= abB)
            {
                return (b, 1);
            }
            double areaC = abA * acB - abB * acA;
            if (areaC <= 0.0 && abA >= 0.0 && abB <= 0.0)
            {
                return (a + ab * (abA / (abA - abB)), 3);
            }
            double abC = Double3.Dot(ab, point - c);
            double acC = Double3.Dot(ac, point - c);
            if (acC >= 0.0 && abC <= acC)
            {
                return (c, 2);
            }
            double areaB = abC * acA - abA * acC;
            if (areaB <= 0.0 && acA >= 0.0 && acC <= 0.0)
            {
                return (a + ac * (acA / (acA - acC)), 5);
            }
            double areaA = abB * acC - abC * acB;
            if (areaA <= 0.0 && acB - abB >= 0.0 && abC - acC >= 0.0)
            {
                return (b + (c - b) * ((acB - abB) / (acB - abB + abC - acC)), 4);
            }
            double area = areaA + areaB + areaC;
            return (a + ab * (areaB / area) + ac * (areaC / area), 6);
        }
    }
}
