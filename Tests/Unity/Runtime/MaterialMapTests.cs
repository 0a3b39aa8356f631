#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
#if UNITY_6000_0_OR_NEWER
using SurfacePhysics = UnityEngine.PhysicsMaterial;
#else
using SurfacePhysics = UnityEngine.PhysicMaterial;
#endif

namespace HaptoFlow.Tests
{
    /// <summary>The rules and maps that assign a material to a collider without a surface.</summary>
    public sealed class MaterialMapTests : MapTest
    {
        [UnityTest]
        public IEnumerator AColliderWithoutSurfaceIsFeltWhereARuleMatchesIt()
        {
            Bare().gameObject.tag = "Finish";
            Map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            HapticStylus stylus = Resting();
            var log = new TouchLog(stylus);
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("stone"));
            Assert.That((log.Began, stylus.Contact.Collider.name), Is.EqualTo((1, "Plank")));
            Assert.That(stylus.Contact.Surface, Is.Null);
            Assert.That(stylus.Contact.Material!.Label, Is.EqualTo("stone"));
            Assert.That(stylus.Contact.Explain(), Is.EqualTo("rule 1 of \"Project\": tag \"Finish\""));
        }

        [UnityTest]
        public IEnumerator EveryKindOfRuleFindsItsObject()
        {
            BoxCollider box = Bare("Old Rug (1)");
            box.gameObject.layer = 4;
            box.gameObject.tag = "Respawn";
            box.sharedMaterial = Keep(new SurfacePhysics("Ice"));
            var renderer = box.gameObject.AddComponent<MeshRenderer>();
            Material oak = Paint("Oak");
            renderer.sharedMaterial = oak;
            HapticStylus stylus = Resting();
            yield return null;
            HapticMaterialRule[] rules =
            {
                HapticMaterialRule.ForTag("Respawn", Feeling("wood")),
                HapticMaterialRule.ForLayer(4, Feeling("stone")),
                HapticMaterialRule.ForPhysicsMaterial(box.sharedMaterial!, Feeling("glass")),
                HapticMaterialRule.ForRendererMaterial(oak, Feeling("jute")),
                HapticMaterialRule.ForName("*rug*", Feeling("fur")),
            };
            foreach (HapticMaterialRule rule in rules)
            {
                Map.Clear();
                Map.Add(rule);
                yield return null;
                Assert.That(FeltAlone(stylus), Is.EqualTo(rule.Material!.Description.Label), rule.Describe());
            }
        }

        [UnityTest]
        public IEnumerator AColliderWithoutRendererUsesOneAboveOrBelowItButNoTrail()
        {
            Material oak = Paint("Oak");
            Map.Add(HapticMaterialRule.ForRendererMaterial(oak, Feeling("wood")));
            BoxCollider box = Bare();
            box.gameObject.AddComponent<TrailRenderer>().sharedMaterial = oak;
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False, "the renderer of a trail is ignored");
            GameObject below = Make("Look");
            below.transform.SetParent(box.transform, false);
            below.AddComponent<SkinnedMeshRenderer>().sharedMaterial = oak;
            HapticMaterialMap.Refresh();
            yield return FeelsNext(stylus, "wood");
            GameObject above = Make("Parent");
            above.AddComponent<MeshRenderer>().sharedMaterial = Paint("Ice");
            box.transform.SetParent(above.transform, true);
            HapticMaterialMap.Refresh();
            yield return null;
            Assert.That(stylus.IsTouching, Is.False, "a renderer above takes precedence over one below");
        }

        [UnityTest]
        public IEnumerator AnEndedContactStillNamesItsRuleAlsoAfterItsMapWasDestroyed()
        {
            Bare();
            HapticMaterialMap map = MapNamed("Other");
            map.DefaultMaterial = Feeling("wood");
            HaptoFlowSettings.Active.MaterialMap = map;
            HapticStylus stylus = Resting();
            yield return Frames(2);
            HapticContact contact = stylus.Contact;
            Object.DestroyImmediate(map);
            Assert.That(contact.Explain(), Is.EqualTo("a deleted map"));
        }

        [UnityTest]
        public IEnumerator TheFirstMatchingRuleAppliesAlsoWithoutAMaterial()
        {
            Bare();
            Map.Add(HapticMaterialRule.ForName("Plank", Feeling("wood")));
            Map.Add(HapticMaterialRule.ForName("*", Feeling("stone")));
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("wood"));
            Map.Insert(0, HapticMaterialRule.ForLayer(0, null));
            yield return null;
            Assert.That(stylus.IsTouching, Is.False, "the first rule gives no material");
            Map.RemoveAt(0);
            yield return FeelsNext(stylus, "wood");
        }

        [UnityTest]
        public IEnumerator AColliderThatNoRuleMatchesGetsTheDefaultMaterial()
        {
            Bare();
            Map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            Map.DefaultMaterial = Feeling("rubber");
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("rubber"));
            Assert.That(stylus.Contact.Explain(), Is.EqualTo("default of \"Project\""));
        }

        [UnityTest]
        public IEnumerator AnEnabledHapticSurfaceTakesPrecedenceOverEveryRule()
        {
            HapticSurface board = Board("glass");
            Map.DefaultMaterial = Feeling("rubber");
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("glass"));
            Assert.That(stylus.Contact.Explain(), Is.EqualTo("Haptic Surface on \"glass\""));
            board.enabled = false;
            yield return FeelsNext(stylus, "rubber");
            board.enabled = true;
            yield return FeelsNext(stylus, "glass");
        }

        [UnityTest]
        public IEnumerator TheMapsOfASceneAreTriedInOrderBeforeTheProjectsMap()
        {
            Bare();
            Map.DefaultMaterial = Feeling("rubber");
            HapticStylus stylus = Resting();
            HapticMaterialMapScope late = Scope("Late", 2, HapticMaterialRule.ForName("Plank", Feeling("stone")));
            HapticMaterialMapScope early = Scope("Early", 1, HapticMaterialRule.ForName("P*", Feeling("wood")));
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("wood"));
            Assert.That(stylus.Contact.Explain(), Is.EqualTo("rule 1 of \"Early\": name \"P*\""));
            early.enabled = false;
            yield return FeelsNext(stylus, "stone");
            early.enabled = true;
            late.Order = 0;
            yield return FeelsNext(stylus, "stone");
            Object.DestroyImmediate(late.gameObject);
            early.Map = MapNamed("Empty");
            yield return FeelsNext(stylus, "rubber", "the scene's map has no rule and no default");
        }

        [UnityTest]
        public IEnumerator StiffnessStrengthAndOwnMotionComeFromTheRulesMaterial()
        {
            BoxCollider box = Bare();
            Map.DefaultMaterial = Feeling("wood", material => material.StiffnessNewtonsPerMetre = 200f);
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(0.2f).Within(0.01f), "200 N/m, 1 mm deep");
            Map.DefaultMaterial.Description.StiffnessNewtonsPerMetre = 400f;
            yield return null;
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(0.02f));
            var mover = box.gameObject.AddComponent<PathMover>();
            mover.Path = seconds => new Vector3(0.1f * (float)seconds, 0f, 0f);
            yield return Frames(30);
            Assert.That(Mathf.Abs(stylus.Contact.FirstVelocityMps), Is.EqualTo(0.1f).Within(0.03f),
                "the plank moves under the tip");
        }

        [UnityTest]
        public IEnumerator ARuleDoesNotMakeAPenTouchItselfOrItsHolder()
        {
            Map.DefaultMaterial = Feeling("rubber");
            GameObject rig = Make("Rig");
            rig.AddComponent<CharacterController>();
            HapticStylus stylus = Resting();
            stylus.transform.SetParent(rig.transform, true);
            stylus.gameObject.AddComponent<SphereCollider>();
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator SlidingBetweenCollidersWithRulesRaisesSurfaceChanged()
        {
            Bare("Left").center = new Vector3(-0.2f, -0.01f, 0f);
            Bare("Right").center = new Vector3(0.2f, -0.01f, 0f);
            Map.Add(HapticMaterialRule.ForName("Left", Feeling("wood")));
            Map.Add(HapticMaterialRule.ForName("Right", Feeling("stone")));
            HapticStylus stylus = StylusAlong(seconds => new Vector3(-0.02f + 0.2f * (float)seconds, 0.001f, 0f));
            int changes = 0;
            stylus.SurfaceChanged += (HapticStylus _, in HapticContact contact) => ++changes;
            string first = "";
            for (int frame = 0; frame < 30; ++frame)
            {
                yield return null;
                first = first.Length == 0 ? FeltAlone(stylus) : first;
            }
            Assert.That(first, Is.EqualTo("wood"));
            Assert.That(FeltAlone(stylus), Is.EqualTo("stone"));
            Assert.That(changes, Is.EqualTo(1));
        }

        [TestCase("Floor", "Floor", ExpectedResult = true)]
        [TestCase("floor", "FLOOR", ExpectedResult = true)]
        [TestCase("*", "", ExpectedResult = true)]
        [TestCase("*", "anything", ExpectedResult = true)]
        [TestCase("Rug*", "Rug(Clone)", ExpectedResult = true)]
        [TestCase("*rug*", "Old Rug (1)", ExpectedResult = true)]
        [TestCase("a*b*c", "aXbYbZc", ExpectedResult = true)]
        [TestCase("**a", "a", ExpectedResult = true)]
        [TestCase("*ab", "aaab", ExpectedResult = true)]
        [TestCase("*\u00e4hre*", "Alte A\u0308HRE 2", ExpectedResult = true)]
        [TestCase("vie\u0323\u0302t*", "VI\u1ec6T (1)", ExpectedResult = true)]
        [TestCase("ISTANBUL", "istanbul", ExpectedResult = true)]
        [TestCase("", "", ExpectedResult = false)]
        [TestCase("", "Floor", ExpectedResult = false)]
        [TestCase("Floor", "Floor 2", ExpectedResult = false)]
        [TestCase("Floor", "The Floor", ExpectedResult = false)]
        [TestCase("*rug", "rug (1)", ExpectedResult = false)]
        [TestCase("a*b*c", "acb", ExpectedResult = false)]
        [TestCase("*ab", "aba", ExpectedResult = false)]
        [TestCase("Mu*", "M\u0075\u0308tze", ExpectedResult = false)]
        [TestCase("istanbul", "\u0130stanbul", ExpectedResult = false)]
        public bool APatternMatchesTheWholeNameWhateverItsCase(string pattern, string name) =>
            NamePattern.Matches(pattern, name);

        private HapticMaterialMapScope Scope(string name, int order, HapticMaterialRule rule)
        {
            HapticMaterialMap map = MapNamed(name);
            map.Add(rule);
            var scope = Make(name).AddComponent<HapticMaterialMapScope>();
            scope.Map = map;
            scope.Order = order;
            return scope;
        }
    }
}
